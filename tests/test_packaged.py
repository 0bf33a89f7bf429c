"""What the packaged inputs say of themselves is so: closed forms by hand, figures measured over
hundreds of runs."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import chi2

from ekfsim.commands import Sense
from ekfsim.diagnostics.verdict import Evidence, Verdict
from ekfsim.files.packaged import description_of, folder, packaged
from ekfsim.files.scenes.load import check, read_scene
from ekfsim.filters.tuning import CROWDS
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import cone_halfwidth, ellipse
from ekfsim.localization import play
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.student.exposing.exposed import exposed, possible
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.study.block import run_block
from ekfsim.study.expectation import verified
from ekfsim.study.plan import Case
from ekfsim.study.results import Result

FOUND = {name: check(path).get() for name, path in packaged("commands").items()}
# the others: tests/systems
COMMANDS = [name for name, scene in FOUND.items() if scene.world.system == "classroom"]
PROOFS = [name for name in COMMANDS if name.startswith("proof-")]
DIVERGENCES = [name for name in COMMANDS if name.startswith("diverge-")]
K = math.sqrt(-2 * math.log(1 - 0.954))  # standard deviations to the edge of the 95.4 % ellipse
QUARTER = math.pi / 2
EVERY = "proof-every-mistake"


@cache
def scene(name: str) -> Scene:
    return read_scene(packaged("commands")[name]).get()


@cache
def steps(name: str) -> list[Step]:
    return list(play(scene(name)))


def covariances(name: str) -> list[Array]:
    """P after each step in which something was given to the filter, and at the start."""
    return [
        step.posterior.covariance
        for step in steps(name)
        if step.entry.given or step.entry.index == 0
    ]


def senses(name: str) -> list[Step]:
    return [step for step in steps(name) if isinstance(step.entry.command, Sense)]


@cache
def evidence(name: str) -> Evidence:
    found = Evidence()
    for step in steps(name):
        found.add(step)
    return found


@cache
def studied(name: str, runs: int) -> Result:
    return study(scene(name), runs)


def study(played: Scene, runs: int) -> Result:
    """What a study of runs 0 … runs − 1 says; at most a block of them."""
    return Result(Case((), played), run_block(played, 0, runs))


def radii(P: Array) -> tuple[float, float]:
    """Major and minor radius as they are drawn and told."""
    drawn = ellipse(P, 0.954)
    return float(drawn.major), float(drawn.minor)


def cone(P: Array) -> float:
    """Half the opening of the cone, in degrees, as it is drawn and told."""
    return math.degrees(cone_halfwidth(P[2, 2], 0.954))


@pytest.mark.parametrize("kind", ["worlds", "commands"])
def test_every_file_is_right_and_described(kind):
    for name, path in packaged(kind).items():
        found = check(path)
        assert not found.mistakes, name
        assert not found.warnings, name
        assert 20 <= len(description_of(path)) <= 80, name
        assert description_of(path).endswith("."), name


def test_every_world_is_used():
    named = [Path(scene.world_source) for scene in FOUND.values()]
    used = {path.stem for path in named if path.parent.name == "worlds"}  # and not made for a log
    assert used == set(packaged("worlds"))


@pytest.mark.parametrize("name", COMMANDS)
def test_every_scene_runs_to_its_end_and_bumps_into_nothing(name):
    last = steps(name)[-1]
    assert np.isfinite(last.posterior.mean).all()
    assert np.isfinite(last.posterior.covariance).all()
    assert not any(step.entry.bump is not None and step.entry.bump >= 0 for step in steps(name))


@pytest.mark.parametrize("name", [name for name in COMMANDS if scene(name).expect])
def test_every_promise_of_a_file_is_kept(name):
    runs = 60 if scene(name).filter in CROWDS else scene(name).expect.runs  # particles take long
    kept = {finding.name: finding.kept for finding in verified(studied(name, runs))}
    assert kept == dict.fromkeys(kept, True)


@pytest.mark.parametrize("name", DIVERGENCES)
def test_every_divergence_says_what_a_study_must_find(name):
    expect = scene(name).expect
    assert expect is not None
    assert None not in (expect.lost, expect.nis, expect.nees)


SHOWN = {
    "diverge-00-control": (Verdict.CONSISTENT, "silent"),
    "diverge-01-wrong-wall": (Verdict.LOST, "high"),
    "diverge-02a-odometry-overtrusted": (Verdict.LOST, "high"),
    "diverge-02b-laser-overtrusted": (Verdict.LOST, "high"),
    "diverge-02c-laser-distrusted": (Verdict.OVER_CAUTIOUS, "low"),
    "diverge-03a-wheel-scale": (Verdict.OVER_CONFIDENT, "high"),
    "diverge-03b-turn-scale": (Verdict.LOST, "high"),
    "diverge-03c-slip": (Verdict.LOST, "high"),
    "diverge-04a-range-bias-all-round": (Verdict.LOST, "high"),
    "diverge-04b-range-bias-one-sided": (Verdict.LOST, "silent"),
    "diverge-05a-misplaced-wall": (Verdict.LOST, "high"),
    "diverge-05b-sheared-map": (Verdict.LOST, "silent"),
    "diverge-06a-corridor": (Verdict.CONSISTENT, "silent"),
    "diverge-06b-pillar-corridor": (Verdict.LOST, "high"),
    "diverge-07-heading-spread": (Verdict.LOST, "silent"),
    "diverge-08-grazing": (Verdict.LOST, "silent"),
    "diverge-09-wrong-start": (Verdict.OVER_CONFIDENT, "high"),
    "diverge-10-standstill": (Verdict.LOST, "silent"),
    "diverge-11-short-returns": (Verdict.LOST, "high"),
    "diverge-12-close-to-the-wall": (Verdict.LOST, "silent"),
}  # fmt: skip


@pytest.mark.parametrize("name", DIVERGENCES)
def test_the_packaged_run_shows_its_mechanism(name):
    """The verdict, and whether the NIS alone (two-sided 95 %) would have told."""
    found, (verdict, nis) = evidence(name), SHOWN[name]
    low, high = chi2.ppf([0.025, 0.975], found.nis_dof)
    assert found.verdict is verdict
    assert ("high" if found.nis_sum > high else "low" if found.nis_sum < low else "silent") == nis


CURES = [  # how a scene is changed, and the share that is lost with it
    ("diverge-01-wrong-wall", {"guard": "skip"}, 0, 0.03),
    ("diverge-01-wrong-wall", {"gate": 0.99}, 0, 0.03),
    ("diverge-02a-odometry-overtrusted", {"gate": 0.99}, 0.55, 0.80),
    ("diverge-03c-slip", {"gate": 0.99}, 0.98, 1),
    ("diverge-05b-sheared-map", {"gate": 0.99}, 0.15, 0.50),
    ("diverge-06b-pillar-corridor", {"gate": 0.99}, 0, 0.08),
    ("diverge-06b-pillar-corridor", {"guard": "skip"}, 0.5, 0.8),
    ("diverge-08-grazing", {"guard": "skip"}, 0.03, 0.25),
    ("diverge-09-wrong-start", {"gate": 0.99}, 0.98, 1),
    ("diverge-11-short-returns", {"gate": 0.99}, 0, 0.03),
]


@pytest.mark.parametrize(("name", "change", "low", "high"), CURES)
def test_what_cures_cures_and_what_kills_kills(name, change, low, high):
    assert low <= study(replace(scene(name), **change), 100).last.lost.value <= high


def test_the_tour_is_consistent_and_hardly_ever_lost():
    found = evidence("tour")
    assert found.verdict is Verdict.CONSISTENT
    assert found.nis_dof == 15
    assert studied("tour", 300).last.lost.value < 0.02
    assert studied("tour", 300).last.ellipse.value > 0.92


def test_the_tour_ends_a_few_centimetres_off_where_the_odometry_alone_is_far_off():
    reckoned = steps("tour")[0].posterior.mean
    for step in steps("tour"):
        if hasattr(step.entry.given, "u"):
            (x, y, θ), (d, a) = reckoned, step.entry.given.u
            reckoned = np.array([x + d * math.cos(θ), y + d * math.sin(θ), θ + a])
    truth = steps("tour")[-1].entry.truth
    assert math.dist(steps("tour")[-1].posterior.mean[:2], truth[:2]) == pytest.approx(
        0.02, abs=0.005
    )
    assert math.dist(reckoned[:2], truth[:2]) == pytest.approx(0.64, abs=0.005)


def test_the_square_is_consistent():
    assert evidence("square").verdict is Verdict.CONSISTENT


def test_distance_noise_makes_a_line_that_grows_like_a_hypotenuse():
    for P, σ in zip(covariances("proof-distance-noise"), (0, 0.3, 0.5), strict=True):
        c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
        assert_allclose(
            P, σ**2 * np.array([[c * c, c * s, 0], [c * s, s * s, 0], [0, 0, 0]]), atol=1e-12
        )
        assert radii(P) == pytest.approx((2.4816 * σ, 0), abs=5e-5)


def test_turn_noise_opens_the_cone_alone():
    for P, degrees in zip(covariances("proof-turn-noise"), (0, 9, 15), strict=True):
        assert_allclose(P, np.diag([0, 0, math.radians(degrees) ** 2]), atol=1e-12)
        assert cone(P) == pytest.approx(2 * degrees)
        assert radii(P) == (0, 0)
    assert math.degrees(steps("proof-turn-noise")[-1].posterior.mean[2]) == pytest.approx(-120)


def test_a_beam_shrinks_the_ellipse_across_the_wall_alone():
    for P, xx in zip(covariances("proof-across-wall"), (0.01, 0.01 / 2, 0.01 / 3), strict=True):
        assert_allclose(P, np.diag([xx, 0.01, 0]), atol=1e-12)
        assert radii(P) == pytest.approx((0.2482, 2.4816 * math.sqrt(xx)), abs=1e-4)
    gains = [step.correction.K[:, 0] for step in senses("proof-across-wall")]
    assert_allclose(gains, [[-1 / 2, 0, 0], [-1 / 3, 0, 0]], atol=1e-12)
    assert evidence("proof-across-wall").verdict is Verdict.OVER_CAUTIOUS


def test_two_opposite_beams_undo_a_bias():
    x, P = 4.0, 0.2**2
    for wall, sign, step in zip((8, 0), (-1, 1), senses("proof-two-beams"), strict=True):
        h = abs(wall - x)
        gain = P / (P + (0.05 * h) ** 2)
        x, P = x + sign * gain * (4.1 - h), (1 - gain) * P
        assert step.posterior.mean[0] == pytest.approx(x, abs=1e-12)
        assert step.posterior.covariance[0, 0] == pytest.approx(P, abs=1e-12)
    assert [round(step.posterior.mean[0], 4) for step in senses("proof-two-beams")] == [
        3.95,
        4.0008,
    ]
    assert math.sqrt(P) == pytest.approx(0.115, abs=5e-4)


def test_a_square_driven_twice_doubles_the_covariance():
    laps = covariances("proof-square-twice")
    da, dd = (0.02 * QUARTER) ** 2, (0.02 * 3) ** 2
    once = np.array([[18 * da + 2 * dd, -9 * da], [-9 * da, 18 * da + 2 * dd]])
    for lap in (1, 2):
        assert_allclose(laps[4 * lap][:2, :2], lap * once, rtol=1e-9)
        assert laps[4 * lap][2, 2] == pytest.approx(lap * 4 * da)
    assert radii(laps[4]) == pytest.approx((0.4566, 0.3147), abs=1e-4)
    assert radii(laps[8]) == pytest.approx((0.6457, 0.4451), abs=1e-4)
    assert math.degrees(ellipse(laps[8], 0.954).orientation) == pytest.approx(135)
    assert (cone(laps[4]), cone(laps[8])) == pytest.approx((7.2, 10.18), abs=5e-3)
    assert_allclose(laps[8], 2 * laps[4], rtol=1e-9)


def test_a_doubtful_heading_makes_the_ellipse_wide():
    P, σ = covariances("proof-heading-bends")[-1], math.radians(5)
    expected = [[(0.02 * 6) ** 2, 0, 0], [0, (6 * σ) ** 2, 6 * σ**2], [0, 6 * σ**2, σ**2]]
    assert_allclose(P, expected, atol=1e-12)
    assert radii(P) == pytest.approx((1.2994, 0.2978), abs=1e-4)
    assert 6 * (1 - math.cos(math.radians(10))) == pytest.approx(0.09, abs=5e-3)


def test_two_beams_beside_a_corner_have_mirrored_derivatives():
    left, right = senses("proof-corner")
    per, r = 1 / math.cos(math.radians(44)), 4 / math.cos(math.radians(44))
    tangent = math.tan(math.radians(44))
    assert_allclose(left.correction.H, [[0, -per, -r * tangent]], atol=1e-9)
    assert_allclose(right.correction.H, [[-per, 0, r * tangent]], atol=1e-9)
    assert (round(r, 4), round(per, 4), round(r * tangent, 4)) == (5.5607, 1.3902, 5.3699)
    for step, edge in ((left, 2), (right, 1)):
        assert step.correction.predicted[0] == pytest.approx(r)
        assert step.remark.ambiguous
        assert step.entry.given.sensor.walls.name(int(step.remark.wall)) == ("boundary", edge)


def test_a_beam_ends_at_the_nearest_wall_and_a_wall_at_its_corners():
    ahead, past = senses("proof-nearest-wall")
    assert ahead.correction.predicted[0] == pytest.approx(4)
    assert past.correction.predicted[0] == pytest.approx(7 / math.cos(math.radians(20)))
    met = [step.entry.given.sensor.walls.name(int(step.remark.wall)) for step in (ahead, past)]
    assert met == [("desk", 0), ("boundary", 1)]
    assert not any(step.remark.ambiguous for step in (ahead, past))
    assert [P[0, 0] for P in covariances("proof-nearest-wall")[:2]] == pytest.approx([0.04, 0.02])
    # nearer than what is met, were they endless: the desk's upper edge and its front
    tilt = math.radians(20)
    told = (
        round(1 / math.sin(tilt), 4),
        round(4 / math.cos(tilt), 4),
        round(7 / math.cos(tilt), 4),
    )
    assert told == (2.9238, 4.2567, 7.4492)
    assert 4 * math.tan(tilt) - 1 == pytest.approx(0.46, abs=5e-3)


def test_each_step_begins_with_what_the_one_before_ended_with():
    first, *later = senses("proof-one-after-another")
    x, θ = 4.0, math.radians(30)
    P = np.diag([0.2**2 + 0.1**2, math.radians(3) ** 2])  # of x and θ; y is certain
    for bearing, step in zip((0, -60), (first, *later), strict=True):
        beam = θ + math.radians(bearing)
        r = (8 - x) / math.cos(beam)
        H = np.array([-1 / math.cos(beam), r * math.tan(beam)])
        S = H @ P @ H + (0.05 * r) ** 2
        assert step.correction.predicted[0] == pytest.approx(r)
        assert step.correction.H[0] == pytest.approx([H[0], 0, H[1]])
        assert step.correction.S[0, 0] == pytest.approx(S)
        x, θ = np.array([x, θ]) + P @ H / S * (4 / math.cos(math.radians(30)) - 0.1 - r)
        P = P - np.outer(P @ H, P @ H) / S
        assert step.posterior.mean == pytest.approx([x, 4, θ])
        assert step.posterior.covariance[::2, ::2] == pytest.approx(P)
    c, (second,) = first.correction, later
    assert [round(float(each), 4) for each in (*c.H[0, ::2], c.R[0, 0], c.S[0, 0])] == [
        *(-1.1547, 2.6667, 0.0533, 0.1395),
    ]
    told = [first.posterior.mean[0], math.degrees(first.posterior.mean[2]), x]
    assert [round(float(each), 4) for each in told] == [4.0414, 29.6997, 4.062]
    assert round(float(second.correction.predicted[0]), 4) == 4.5849
    assert not any(step.remark.ambiguous for step in (first, second))


def test_the_wall_is_the_expected_one_whatever_was_read():
    (start, last) = (step for step in steps("proof-expected-wall"))
    assert last.remark.ambiguous
    assert (last.correction.predicted[0], last.entry.given.z[0]) == pytest.approx((4, 7))
    assert last.correction.nis == pytest.approx(3**2 / (0.1**2 + (0.05 * 4) ** 2))
    assert last.correction.nis == pytest.approx(180)
    assert last.posterior.mean == pytest.approx([1 - 3 / 5, 2.5, 0])
    assert last.posterior.covariance[0, 0] == pytest.approx(0.008)
    assert (start.nees.value, last.nees.value) == pytest.approx((4, 49))


def test_an_innovation_of_an_azimuth_is_wrapped():
    _, moved, read = steps("proof-marker-behind")
    assert_allclose(moved.posterior.covariance, np.diag([0.1**2, 0.2**2 + 0.1**2, 0]), atol=1e-15)
    expected = math.degrees(math.atan2(-0.2, -5))
    azimuth, r = (
        math.degrees(float(each[0])) for each in (read.entry.given.z, read.correction.innovation)
    )
    assert (abs(azimuth), r) == pytest.approx((180, -180 - expected))
    assert (round(expected, 4), round(r, 4)) == (-177.7094, -2.2906)
    # the azimuth alone: the elevation says next to nothing of y
    slope = 5 / (5**2 + 0.2**2)
    gain = 0.05 * slope / (0.05 * slope**2 + 0.01 * (0.2 / 25.04) ** 2 + math.radians(1) ** 2)
    assert read.posterior.mean[1] == pytest.approx(0.2 + gain * math.radians(r), abs=1e-4)
    assert round(read.posterior.mean[1], 4) == 0.0264
    assert 0.2 + gain * math.radians(r + 360) == pytest.approx(27.31, abs=0.01)


def test_without_noise_the_estimate_is_the_truth():
    for step in steps("proof-no-noise"):
        assert_allclose(step.posterior.mean, step.entry.truth, atol=1e-12)
        assert not step.posterior.covariance.any()
    assert_allclose(steps("proof-no-noise")[1].posterior.mean, [1, 5, 0], atol=1e-12)
    assert senses("proof-no-noise")[0].entry.given.z[0] == pytest.approx(7)
    assert all(np.isnan(step.correction.nis) for step in senses("proof-no-noise"))
    assert {
        step.entry.given.sensor.walls.name(int(step.remark.wall))[0]
        for step in senses("proof-no-noise")
    } == {
        "boundary",
        "desk",
    }
    assert evidence("proof-no-noise").verdict is Verdict.NO_EVIDENCE


def test_an_uncertain_start_is_drawn_from_the_ellipse_that_is_drawn():
    (first,) = covariances("proof-unsure-start")
    assert_allclose(first, np.diag([0.2**2, 0.1**2, math.radians(2) ** 2]), atol=1e-15)
    assert (*radii(first), cone(first)) == pytest.approx((0.4963, 0.2482, 4), abs=1e-4)
    outside = 1 - studied("proof-unsure-start", 1000).last.ellipse.value
    assert outside == pytest.approx(0.046, abs=3 * math.sqrt(0.046 * 0.954 / 1000))


def test_dead_reckoning_grows_and_stays_honest():
    (*_, last) = steps("proof-dead-reckoning")
    turns = [step.entry.given.u[1] for step in steps("proof-dead-reckoning") if step.entry.given]
    assert last.posterior.covariance[2, 2] == pytest.approx(sum((0.02 * a) ** 2 for a in turns))
    assert cone(last.posterior.covariance) == pytest.approx(10.2, abs=0.3)
    assert evidence("proof-dead-reckoning").verdict is Verdict.NO_EVIDENCE


def test_position_and_heading_err_together():
    """The question on σ_xθ and σ_yθ: a beam that measures y alone closes the cone."""
    driven, sensed = covariances("theta")[1], covariances("theta")[2]
    d, σ = steps("theta")[1].entry.given.u[0], math.radians(6)
    assert d == pytest.approx(6, abs=0.2)
    assert_allclose(
        driven[1:, 1:], [[0.1**2 + (d * σ) ** 2, d * σ**2], [d * σ**2, σ**2]], rtol=1e-9
    )
    assert driven[1, 1] - driven[1, 2] ** 2 / driven[2, 2] == pytest.approx(0.1**2)
    # where the robot would stand, were the heading at the edge of its cone
    aside = driven[1, 2] / driven[2, 2] * 2 * σ
    page = folder("commands").parent / "docs" / "judging" / "position-and-heading.md"
    told = " ".join(page.read_text(encoding="utf-8").split())
    assert f"stand {aside:.2f} m further left (dashed)" in told
    (beam,) = senses("theta")
    assert_allclose(beam.correction.H, [[0, -1, 0]], atol=1e-9)
    C = (0.02 * 3) ** 2
    assert sensed[2, 2] == pytest.approx(σ**2 - driven[1, 2] ** 2 / (driven[1, 1] + C))
    assert (cone(driven), cone(sensed)) == pytest.approx((12, 2.2), abs=0.1)


def test_fifty_beams_at_a_standstill_claim_more_than_they_know():
    (*_, last) = steps("diverge-10-standstill")
    claimed = math.sqrt(last.posterior.covariance[1, 1])
    assert claimed == pytest.approx(1 / math.sqrt(1 / 0.1**2 + 50 / 0.04**2), rel=0.1)
    assert abs(last.posterior.mean[1] - last.entry.truth[1]) > 7 * claimed


def test_the_needle_in_the_corridor_is_the_odometry_alone():
    (*_, last) = steps("diverge-06a-corridor")
    assert radii(last.posterior.covariance)[0] == pytest.approx(K * 0.05 * math.sqrt(16), rel=0.05)


def test_the_wrong_wall_is_told_before_it_is_believed():
    first_lost = evidence("diverge-01-wrong-wall").lost_from
    step = steps("diverge-01-wrong-wall")[first_lost]
    assert step.remark.ambiguous
    assert (
        round(float(step.correction.predicted[0]), 2),
        round(float(step.entry.given.z[0]), 2),
    ) == (1.11, 5.38)
    assert step.correction.nis == pytest.approx(82, abs=0.5)


def shown(name: str) -> set[Mistake]:
    return {one.mistake for one in exposed(FOUND[name]) if one.first is not None}


def test_the_proofs_together_expose_every_known_mistake():
    """Each by one at least that is not made to expose them all."""
    proofs = [name for name in FOUND if name.startswith("proof-") and name != EVERY]
    assert set(KNOWN) - set().union(*map(shown, proofs)) == set()


def test_one_proof_exposes_every_mistake_that_its_robot_can_make():
    assert shown(EVERY) == possible(FOUND[EVERY], KNOWN)
    # all others need an angle that is read, two numbers at once, or a process noise
    assert set(KNOWN) - shown(EVERY) <= shown("proof-marker-behind")
    by = {one.mistake.name: one.first.size for one in exposed(FOUND[EVERY]) if one.first}
    assert {name for name, size in by.items() if size < 0.01} <= {"P-inflated", "S-inflated"}
    assert evidence(EVERY).verdict is Verdict.CONSISTENT
    assert not any(step.remark.ambiguous for step in senses(EVERY))


def test_the_files_lie_where_the_wheel_takes_them_from():
    assert all(path.parent == folder("commands") for path in packaged("commands").values())
