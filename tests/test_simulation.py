import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from recomputation import disagreements, true_course
from scenes import DESK, NOISE, SILENT, rich, scene, told, unbounded
from systems_scenes import mower

from ekfsim.commands import Kidnap, Move, Repeat, Say, Sense
from ekfsim.errors import UsageError
from ekfsim.localization import play
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.records import Control, Reading
from ekfsim.simulation import simulate
from ekfsim.simulation.draws import Draws, particle_generators
from ekfsim.world import Faults, Noise

TURN = math.radians(90)


def lines_of(scene):
    """What happened, as a trace tells it."""
    walls = scene.world.map.walls
    for entry in simulate(scene):
        line = {"truth": entry.truth.tolist()}
        match entry.given:
            case Control(_, u):
                line["odometry"] = {"distance": float(u[0]), "angle": float(u[1])}
                line["bump"] = walls.name(int(entry.bump))[0] if entry.bump >= 0 else None
            case Reading(_, z):
                line["range"] = None if np.isnan(z[0]) else float(z[0])
        yield line


def check(scene):
    for line, expected in zip(lines_of(scene), true_course(scene), strict=True):
        assert disagreements(line, expected, tolerance=1e-12) == []


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("made", [rich, unbounded])
def test_a_run_is_what_its_draws_say(made, seed):
    check(made(seed))


@pytest.mark.parametrize("run", [0, 1, 1023, 1024, 5000])
def test_and_so_is_every_other_run_of_the_seed(run):
    check(dataclasses.replace(rich(), run=run))


commands = st.one_of(
    st.builds(Move, st.floats(-3, 3), st.floats(-7, 7), st.sampled_from([0.0, 0.3, 1.0])),
    st.builds(Sense, st.floats(-7, 7)),
    st.builds(Kidnap, st.floats(1, 9), st.floats(1, 7), st.floats(-9, 9)),
    st.just(Say("a word")),
)


@given(st.lists(commands, max_size=12), st.integers(0, 2**32 - 1), st.integers(0, 3000))
def test_any_course(course, seed, run):
    faults = Faults(-0.4, 0.9, 0.3, 1.1, 0.8)
    check(
        scene(*course, seed=seed, run=run, obstacles=(DESK,), sigma=(0.2, 0.1, 2.0), faults=faults)
    )


def test_the_draws_word_for_word():
    """The start takes normals 0 to 2 of draw 0; the first sense, in a room without scale, normal 0
    of draw 1."""
    made = scene(
        Say("nothing is drawn for this"),
        Sense(TURN),
        seed=7,
        start=(5, 4, 0),
        noise=Noise(0, 0, 0, 0, 1e-3),
    )
    spread = dataclasses.replace(
        made, world=dataclasses.replace(made.world, start_sigma=np.array([1, 1, 1e-3]))
    )
    for b, rows in ((0, [0, 1, 1023]), (1, [1024, 1030, 2047]), (3, [4000])):
        started = np.random.Generator(
            np.random.PCG64(np.random.SeedSequence([7, 0, b]))
        ).standard_normal((1024, 4))
        measured = np.random.Generator(
            np.random.PCG64(np.random.SeedSequence([7, 1, b]))
        ).standard_normal((1024, 4))
        for run in rows:
            start, *_ = simulate(dataclasses.replace(spread, run=run))
            assert start.truth == pytest.approx(
                [5, 4, 0] + [1, 1, 1e-3] * started[run % 1024, :3], abs=1e-12
            )
            *_, sense = simulate(dataclasses.replace(made, run=run))
            assert sense.given.z == pytest.approx(4 + 0.004 * measured[run % 1024, 0], abs=1e-12)


def course(*commands, **settings):
    return [entry for entry in simulate(scene(*commands, **settings)) if entry.given is not None]


def given_to_the_filter(entries):
    return [
        entry.given.u if isinstance(entry.given, Control) else entry.given.z for entry in entries
    ]


def equal(a, b):
    return all(
        (p == q).all() for p, q in zip(given_to_the_filter(a), given_to_the_filter(b), strict=True)
    )


WALK = (Move(1.0, 0.3), Sense(0.5), Move(0.5, -0.2), Sense(-0.5))


def test_nothing_but_moves_and_senses_counts_in_the_draws():
    talk = (Say("one"), WALK[0], Say("two"), *WALK[1:3], Say("three"), WALK[3])
    assert equal(course(*WALK), course(*talk))
    assert [entry.index for entry in course(*talk)] == [2, 4, 5, 7]


def test_repeating_is_writing_it_out():
    assert equal(course(Repeat(2, WALK)), course(*WALK, *WALK))


def test_one_more_command_changes_none_before_it():
    assert equal(course(*WALK), course(*WALK, Move(3.0, 1.0))[:4])


def test_filter_gate_and_guard_change_no_draw():
    assert equal(course(*WALK), course(*WALK, gate=0.5, guard="skip"))


def test_another_ratio_changes_no_other_draw():
    """The same normals, with other sigmas: each error is proportional to its ratio."""
    one = course(Move(2.0, 1.0), Sense(0.0), noise=Noise(0.0, 0.0, 0.01, 0.02, 0.03))
    two = course(Move(2.0, 1.0), Sense(0.0), noise=Noise(0.0, 0.0, 0.02, 0.02, 0.06))
    assert (two[0].given.u[0] - 2) == pytest.approx(2 * (one[0].given.u[0] - 2), rel=1e-9)
    assert two[0].given.u[1] == one[0].given.u[1]
    r = course(Move(2.0, 1.0), Sense(0.0), noise=SILENT)[1].given.z
    assert (two[1].given.z - r) == pytest.approx(2 * (one[1].given.z - r), rel=1e-9)


def test_short_returns_leave_the_noise_of_the_others_alone():
    def readings(probability):
        runs = np.arange(2000)
        made = scene(Sense(0.0), Sense(1.0), faults=Faults(short_returns=probability))
        return [entry.given.z[:, 0] for entry in simulate(made, runs) if entry.given]

    for never, some in zip(readings(0.0), readings(0.3), strict=True):
        assert np.mean(never == some) == pytest.approx(0.7, abs=0.05)
        assert (some[never != some] < never[never != some] * 1.2).all()


def test_a_run_alone_is_its_row_of_the_study():
    made, runs = rich(), np.array([0, 7, 1023, 1024, 4100])
    for row, run in enumerate(runs):
        for one, many in zip(
            simulate(dataclasses.replace(made, run=int(run))), simulate(made, runs), strict=True
        ):
            assert (one.truth == many.truth[row]).all()
            if one.given is not None:
                for a, b in zip(
                    given_to_the_filter([one]), given_to_the_filter([many]), strict=True
                ):
                    np.testing.assert_array_equal(a, b[row])
            assert one.bump is None or one.bump == many.bump[row]


def test_a_large_study_has_the_rows_of_a_small_one():
    few, many = simulate(rich(), np.arange(3)), simulate(rich(), np.arange(1300))
    for a, b in zip(few, many, strict=True):
        np.testing.assert_allclose(a.truth, b.truth[:3], rtol=0, atol=1e-12)


RUNS = np.arange(20_000)


def sampled(*commands, noise=NOISE, **settings):
    return list(simulate(scene(*commands, noise=noise, **settings), RUNS))[1:]


def has_moments(sample, mean, sigma):
    """Within five standard errors."""
    n = len(sample)
    assert np.mean(sample) == pytest.approx(mean, abs=5 * sigma / math.sqrt(n))
    assert np.std(sample) == pytest.approx(sigma, rel=5 / math.sqrt(2 * n))


@pytest.mark.parametrize("sign", [1, -1])
def test_execution_noise_has_its_sigma(sign):
    (entry,) = sampled(
        Move(sign * 2.0, sign * 0.5), start=(5, 4, 0), faults=Faults(odometry_distance_scale=1.2)
    )
    has_moments(entry.truth[:, 0] - 5, sign * 2, 0.05 * 2)
    has_moments(entry.truth[:, 2], sign * 0.5, 0.04 * 0.5)
    assert entry.truth[:, 1] == pytest.approx(4)


@pytest.mark.parametrize("sign", [1, -1])
def test_odometry_noise_has_its_sigma(sign):
    (entry,) = sampled(
        Move(sign * 2.0, sign * 0.5), start=(5, 4, 0), noise=Noise(0, 0, 0.02, 0.03, 0)
    )
    has_moments(entry.given.u[:, 0], sign * 2, 0.02 * 2)
    has_moments(entry.given.u[:, 1], sign * 0.5, 0.03 * 0.5)
    assert abs(np.corrcoef(entry.given.u.T)[0, 1]) < 5 / math.sqrt(len(RUNS))


def test_odometry_noise_follows_what_was_driven_not_what_was_asked():
    (entry,) = sampled(Move(2.0, 0.5), start=(5, 4, 0))
    driven, turned = entry.truth[:, 0] - 5, entry.truth[:, 2]
    has_moments((entry.given.u[:, 0] - driven) / driven, 0, 0.02)
    has_moments((entry.given.u[:, 1] - turned) / turned, 0, 0.03)


def test_range_noise_has_its_sigma():
    (entry,) = sampled(Sense(TURN), start=(5, 4, 0))
    has_moments(entry.given.z[:, 0], 4, 0.01 * 4)


def test_the_start_has_its_sigma():
    starts = next(iter(simulate(scene(start=(5, 4, 0), sigma=(0.3, 0.2, 0.1)), RUNS))).truth
    for axis, (mean, sigma) in enumerate(zip((5, 4, 0), (0.3, 0.2, 0.1), strict=True)):
        has_moments(starts[:, axis], mean, sigma)
    assert (np.abs(np.corrcoef(starts.T) - np.eye(3)) < 5 / math.sqrt(len(RUNS))).all()


def test_errors_of_different_commands_and_seeds_are_independent():
    columns, still = [], Noise(0, 0, 0.02, 0.03, 0.01)
    for seed in (0, 1):
        for entry in sampled(
            Move(1.0, 1.0), Move(1.0, 1.0), Sense(0.0), seed=seed, start=(5, 4, 0), noise=still
        ):
            columns += list(
                (entry.given.u if isinstance(entry.given, Control) else entry.given.z).T
            )
    assert np.abs(np.corrcoef(columns) - np.eye(10)).max() < 6 / math.sqrt(len(RUNS))


def exact(*commands, **settings):
    return course(*commands, noise=SILENT, **settings)


def test_a_bump_ends_a_millimetre_short_and_turns_all_the_same():
    (entry,) = exact(Move(20.0, TURN), start=(5, 4, 0))
    assert entry.truth == pytest.approx([10 - 0.001, 4, TURN])
    assert entry.given.u == pytest.approx([5 - 0.001, TURN])
    assert entry.bump == 1


def test_a_bump_backwards():
    (entry,) = exact(Move(-20.0, 0.0), start=(5, 4, 0))
    assert entry.truth == pytest.approx([0.001, 4, 0])
    assert entry.given.u == pytest.approx([-(5 - 0.001), 0])
    assert entry.bump == 3


def test_bumps_of_a_study_are_those_of_its_runs():
    made = scene(
        *[Move(d, 0.7) for d in (20.0, -20.0, -3.0, 3.0, -20.0)],
        obstacles=(DESK,),
        sigma=(0.3, 0.3, 0.3),
    )
    runs = np.arange(6)
    for entry, *alone in zip(
        *(simulate(s, r) for s, r in ((made, runs), *((made, np.array(k)) for k in runs))),
        strict=True,
    ):
        if entry.bump is not None:
            assert (entry.bump == [one.bump for one in alone]).all()
            np.testing.assert_allclose(
                entry.truth, [one.truth for one in alone], rtol=0, atol=1e-12
            )


@pytest.mark.parametrize("start", [(9, 4, 0), (5, 7, 90), (1, 4, 180), (5, 1, 270)])
def test_many_who_go_the_same_way_are_stopped_by_the_same_wall(start):
    x, y, degrees = start
    made = scene(
        Move(2.0, math.pi), Move(-3.0, 0.0), noise=SILENT, start=(x, y, math.radians(degrees))
    )
    many, one = (list(simulate(made, runs)) for runs in (np.arange(100), np.array(7)))
    for entry, alone in zip(many[1:], one[1:], strict=True):
        assert alone.bump >= 0
        assert (entry.bump == alone.bump).all()
        np.testing.assert_allclose(entry.truth, np.tile(alone.truth, (100, 1)), rtol=0, atol=1e-12)


def test_a_wall_within_a_millimetre_lets_no_way_forward():
    entries = exact(
        Move(20.0, 0.0), Move(1.0, 0.0), Move(0.0, TURN), Move(-1.0, 0.0), start=(5, 4, 0)
    )
    assert [entry.bump >= 0 for entry in entries] == [True, True, False, False]
    assert entries[1].truth == pytest.approx(entries[0].truth)
    assert entries[1].given.u == pytest.approx([0, 0])


def test_just_short_of_the_wall_is_no_bump():
    assert exact(Move(4.9989, 0.0), start=(5, 4, 0))[0].bump == -1
    assert exact(Move(4.9991, 0.0), start=(5, 4, 0))[0].bump == 1


def test_a_bump_is_into_the_true_wall_and_tells_its_obstacle():
    made = told(
        scene(Move(9.0, 0.0), start=(1, 3.5, 0), noise=SILENT, obstacles=(DESK,)),
        map=scene().world.map,
    )
    entry = list(simulate(made))[1]
    assert entry.truth[0] == pytest.approx(4 - 0.001)
    assert made.world.map.walls.name(int(entry.bump)) == ("desk", 3)


def test_slip_moves_the_robot_less_than_its_wheels():
    (entry,) = exact(Move(2.0, 0.3, slip=0.75), start=(5, 4, 0))
    assert entry.truth == pytest.approx([5.5, 4, 0.3])
    assert entry.given.u == pytest.approx([2, 0.3])


def test_wheels_that_slip_altogether():
    (entry,) = exact(Move(20.0, 0.3, slip=1.0), start=(5, 4, 0))
    assert entry.truth == pytest.approx([5, 4, 0.3])
    assert entry.given.u == pytest.approx([20, 0.3])
    assert entry.bump == -1


def test_slip_and_bump():
    """The wheels stop with the robot, having turned twice its way."""
    (entry,) = exact(Move(20.0, 0.0, slip=0.5), start=(5, 4, 0))
    assert entry.truth[0] == pytest.approx(10 - 0.001)
    assert entry.given.u[0] == pytest.approx(2 * (5 - 0.001))


def test_faults_of_the_odometry():
    (entry,) = exact(
        Move(2.0, 0.5),
        start=(5, 4, 0),
        faults=Faults(odometry_distance_scale=1.1, odometry_angle_scale=0.9),
    )
    assert entry.truth == pytest.approx([7, 4, 0.5])
    assert entry.given.u == pytest.approx([2.2, 0.45])


def test_faults_of_the_laser():
    assert exact(Sense(TURN), start=(5, 4, 0), faults=Faults(range_bias=0.1, range_scale=1.5))[
        0
    ].given.z == pytest.approx([6.1])
    assert exact(Sense(TURN), start=(5, 4, 0), faults=Faults(range_bias=-9.0))[0].given.z == [0]


def test_short_returns_lie_uniformly_on_the_way():
    (entry,) = sampled(
        Sense(TURN), noise=SILENT, start=(5, 4, 0), faults=Faults(short_returns=0.25)
    )
    z = entry.given.z[:, 0]
    short = z[z < 4 - 1e-9]
    assert len(short) / len(z) == pytest.approx(0.25, abs=0.02)
    assert np.quantile(short, [0.25, 0.5, 0.75]) == pytest.approx([1, 2, 3], abs=0.1)
    assert (
        sampled(Sense(TURN), noise=SILENT, start=(5, 4, 0), faults=Faults(short_returns=1.0))[
            0
        ].given.z
        < 4
    ).all()


def test_no_echo_stays_none_whatever_is_wrong_with_the_laser():
    faults = Faults(range_bias=0.5, range_scale=2.0, short_returns=1.0)
    assert np.isnan(exact(Sense(0.0), boundary=None, faults=faults)[0].given.z).all()


def test_a_kidnapped_robot_is_where_it_was_carried():
    entries = list(simulate(scene(Kidnap(3.0, 2.0, 7.0), Move(1.0, 0.0), noise=SILENT)))
    assert entries[1].truth == pytest.approx([3, 2, 7 - 2 * math.pi])
    assert entries[1].given is None
    assert entries[2].truth == pytest.approx([3 + math.cos(7), 2 + math.sin(7), 7 - 2 * math.pi])


def test_a_word_changes_nothing():
    start, word = simulate(scene(Say("hello")))
    assert (start.truth == word.truth).all()
    assert word.given is None


def test_the_filter_is_given_what_it_is_told_never_the_truth():
    made = rich()
    for entry in simulate(made):
        match entry.given:
            case Control(motion, _):
                assert motion == MoveTurn(
                    made.world.told.noise.odometry_distance, made.world.told.noise.odometry_angle
                )
            case Reading(Laser() as laser, _):
                assert isinstance(laser.walls, Walls)
                assert laser.walls is made.world.told.map.walls
                assert laser.range_ratio == made.world.told.noise.range


def test_a_scene_without_commands_is_its_start():
    (start,) = simulate(scene())
    assert (start.index, start.given, start.command) == (0, None, None)


@pytest.mark.parametrize("n", [1, 3])
def test_headings_of_the_truth_stay_in_range(n):
    turns = scene(
        *[Move(0.0, 2.0)] * 20, Kidnap(1, 1, 3 * math.pi), start=(1, 1, 3.0), sigma=(0, 0, 9.0)
    )
    for entry in simulate(turns, np.arange(n)):
        assert (entry.truth[:, 2] > -math.pi).all()
        assert (entry.truth[:, 2] <= math.pi).all()


@pytest.mark.parametrize(
    ("seed", "told"),
    [
        (-1, "seed -1 is negative; choose one from 0 to 4294967295"),
        (
            2**32,
            "seed 4294967296 is too large: beyond it NumPy's seed words would repeat the draws of "
            "other seeds; choose "
            "one from 0 to 4294967295",
        ),
    ],
)
def test_a_seed_that_would_repeat_another_is_refused(seed, told):
    for refused in (
        lambda: Draws(seed, np.arange(3)),
        lambda: particle_generators(seed, np.arange(3)),
        lambda: play(dataclasses.replace(rich(), seed=seed)),
        lambda: play(dataclasses.replace(mower(), seed=seed, filter="pf")),
    ):
        with pytest.raises(UsageError) as error:
            list(refused())
        assert str(error.value) == told


def test_runs_are_numbered_from_0():
    with pytest.raises(UsageError) as error:
        play(dataclasses.replace(rich(), run=-2))
    assert str(error.value) == "run -2 is negative; runs are numbered from 0"


def test_no_seed_and_no_run_of_many_bits_has_the_draws_of_another():
    """The draws of runs that differ in one word of their seed or number, up to the largest there
    are."""
    words = (0, 1, 3, 2**32 - 1)
    runs = np.array([*words, *(2**32 + n for n in words[:3]), 2**62 + 5])
    streams = [Draws(seed, runs).stream(0).normals(1, 1)[0, :, 0] for seed in words]
    blocks = [
        Draws(seed, np.array([1024 * n])).normals(i)[0]
        for seed in words
        for i in words[:3]
        for n in runs[:6]
    ]
    for found in (np.concatenate(streams), np.concatenate(blocks)):
        assert len(set(found.tolist())) == len(found) > 30
