"""A log of fixes without a truth begins at its first fix, with a heading by their course."""

import math
from dataclasses import replace

import numpy as np
import pytest
from log_worlds import lay, read, shared, steps_of, table, world

from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import read_log, write_log
from ekfsim.files.logs.start.course import ALL_ROUND, APART, FILTERS, course_of
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import read_scene
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Gaussian, posed
from ekfsim.geometry.angles import wrap
from ekfsim.localization import play
from ekfsim.models.layout import SPEED_POSE
from ekfsim.models.motions.wheel_speeds import WheelSpeeds
from ekfsim.models.sensors.mounted import Mount
from ekfsim.models.sensors.position import Position
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.systems.drives import Stretch, Stretches
from ekfsim.systems.instruments import Gnss
from ekfsim.systems.robots import GnssMower

COURSES = {
    "ahead and round": ((1.0, 0.0, 3.0), (1.0, 0.5, 3.0)),
    "in reverse": ((-0.7, 0.3, 3.0), (1.0, 0.0, 2.0)),
    "standing first": ((0.0, 0.0, 4.0), (1.0, 0.0, 3.0)),
    "on the spot first": ((0.0, 1.0, 2.0), (1.0, 0.2, 3.0)),
}


def truthless(folder, drive, heading, seed):
    """A recorded drive without its truth; the truth : (n, 4) t, x, y, θ, and the scene that plays
    it.
    """
    place = world("gnss", start=(30.0, -4.0, heading), robot=replace(GnssMower(), rate=50.0),
                  instruments=(Gnss(rate=5.0),))  # fmt: skip
    scene = Scene(place, drive=Stretches(tuple(Stretch(*one) for one in drive)), seed=seed)
    write_log(scene, simulate(scene), folder, force=True, format="own")
    truth = np.loadtxt(folder / "groundtruth.csv", delimiter=",", skiprows=1)
    (folder / "groundtruth.csv").unlink()
    found = read_log(RecordingKeys(format="gnss"), folder, world("gnss", robot=place.robot,
                     instruments=place.instruments), "corrected")  # fmt: skip
    return truth, replace(scene, world=found_in(place), drive=None, log=found.log)


def found_in(place):
    return replace(place, start=np.zeros(3))


def held_against(truth, scene):
    """NEES of the heading, and the errors in m and rad, at each step : (n,) each"""
    nees, off, turned = [], [], []
    for step in play(scene):
        true = truth[np.argmin(np.abs(truth[:, 0] - step.entry.t))]
        mean, P = posed(step.posterior, scene.world.layout)
        turned.append(float(wrap(mean[2] - np.array(true[3]))))
        off.append(math.hypot(*(mean[:2] - true[1:3])))
        nees.append(turned[-1] ** 2 / P[2, 2])
    return np.array(nees), np.array(off), np.array(turned)


@pytest.mark.parametrize("drive", COURSES)
def test_its_heading_is_believed_honestly_from_all_round(tmp_path, drive):
    """Ten logs for each way to begin, with headings all round: of 40 in all hardly a start, a
    moment or an end beyond the 99 % bound of the heading's NEES.
    """
    beyond, ends, firsts = [], [], []
    for k in range(10):
        heading = float(wrap(np.array(0.2 + 2 * math.pi * k / 10)))
        truth, scene = truthless(tmp_path / "log", COURSES[drive], heading, seed=k)
        nees, off, turned = held_against(truth, scene)
        beyond.append(np.mean(nees > quantile(0.99, 1)))
        firsts.append(nees[0])
        ends.append((off[-1], abs(turned[-1])))
    assert np.mean(beyond) < 0.04
    assert np.mean(np.array(firsts) > quantile(0.99, 1)) == 0
    assert np.max(ends, axis=0) == pytest.approx([0.2, 0.35], abs=0.25)


def drive(turn=0.0, seconds=3.0, sigma=0.15, speed=1.0):
    """A start and the entries after it, of a robot that drives with odometry and fixes that do not
    err: it begins at (2, 3), and its fixes stand where its odometry says.
    """
    layout, motion = SPEED_POSE, WheelSpeeds(0.27, 1e-4, 1e-4)
    x, sensor = layout.state(np.array([2.0, 3.0, turn])), Position(sigma, sigma, SPEED_POSE)
    entries, u = [], np.array([speed, speed, 0.1])
    for k in range(1, round(seconds / 0.1) + 1):
        x = motion.f(x, u)
        entries.append(Entry(2 * k - 1, Control(motion, u), t=k / 10))
        entries.append(Entry(2 * k, Reading(sensor, x[2:4]), t=k / 10))
    means = layout.state(np.stack(np.broadcast_arrays(2.0, 3.0, ALL_ROUND), axis=-1))
    P = np.diag([1.0, APART**2, sigma**2, sigma**2])
    return entries, Gaussian(means, np.broadcast_to(P, (FILTERS, 4, 4)))


@pytest.mark.parametrize("turn", [0.1, 1.5, math.pi, -2.9])
@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_a_course_is_as_sure_as_a_straight_line_through_its_fixes(turn, speed):
    """Least squares: σ² / Σ (d − mean d)², the fix at the start included, and the doubt of each
    filter.
    """
    entries, around = drive(turn, speed=speed)
    found = course_of(entries, around, SPEED_POSE)
    assert float(wrap(np.array(found.heading - turn))) == pytest.approx(0, abs=0.01)
    d = np.arange(found.fixes + 1) / 10
    doubt = 0.15**2 / np.sum((d - d.mean()) ** 2)
    assert found.sigma == pytest.approx(math.sqrt(doubt + APART**2), rel=0.1)


def test_a_receiver_that_repeats_its_fix_tells_no_course():
    entries, around = drive(turn=1.0)
    held = [
        replace(entry, given=replace(entry.given, z=np.array([2.0, 3.0])))
        if isinstance(entry.given, Reading) else entry for entry in entries
    ]  # fmt: skip
    found = course_of(held, around, SPEED_POSE)
    assert found.fixes == 1
    assert found.sigma == pytest.approx(math.pi / math.sqrt(3), rel=0.2)


def test_a_robot_that_stands_tells_none(tmp_path):
    fixes = [[k / 5, *np.random.default_rng(k).normal(0, 0.15, 2).tolist()] for k in range(1, 50)]
    wheels = [[k / 10, 0.0, 0.0] for k in range(101)]
    folder = lay(tmp_path / "log", **{"wheelspeeds.csv": table("t,vl,vr", wheels),
                                      "gnss.csv": table("t,x,y", fixes)})  # fmt: skip
    found = read("gnss", folder, world("gnss", start=(9.0, 9.0, 0.5)))
    mean, P = found.log.first
    np.testing.assert_allclose(mean, [0, 0.5, *fixes[0][1:]])
    np.testing.assert_allclose(np.sqrt(np.diag(P)), [1, math.pi / math.sqrt(3), 0.15, 0.15])
    assert "and 104°, its heading unknown: " in found.warnings[-1]


def test_the_first_fix_is_the_start_and_not_read_again(tmp_path):
    wheels = [[k / 10, 1.0, 1.0] for k in range(51)]
    fixes = [[0.25 + k / 5, 7.25 + k / 5, 3.0] for k in range(20)]
    folder = lay(tmp_path / "log", **{"wheelspeeds.csv": table("t,vl,vr", wheels),
                                      "gnss.csv": table("t,x,y", fixes)})  # fmt: skip
    found = read("gnss", folder, world("gnss"))
    entries = found.log.entries
    assert (entries[0].t, entries[0].given) == (0.25, None)
    assert sum(isinstance(entry.given, Reading) for entry in entries) == 19
    mean, P = found.log.first
    np.testing.assert_allclose(mean[2:], [7.25, 3])
    assert abs(mean[1]) < 0.01
    np.testing.assert_allclose(np.sqrt(np.diag(P))[2:], 0.15)
    (told,) = [line for line in found.warnings if "starts at" in line]
    assert told.startswith(
        f"{folder}: starts at 0.25 s, at its first fix: (7.25, 3, 0°) to within 0.15 m and "
    )
    assert ", its heading told by the course of " in told
    assert told.endswith(
        "; say otherwise with --set start.x=… (y, theta) and --set belief.sigma.x=… (y, theta)"
    )


@pytest.mark.parametrize(
    ("start", "begins"),
    [
        ("{x: 7, y: 3, theta: 0}", (0.0, [7, 3, 0])),  # where the fixes come from
        ("{x: 0, y: 3, theta: 0}", (0.5, [7.5, 3, 0])),
        ("{x: 7, y: 3, theta: 170}", (0.5, [7.5, 3, 0])),
    ],
)
def test_the_start_of_a_world_of_one_s_own_counts_if_the_fixes_bear_it_out(tmp_path, start, begins):
    place = tmp_path / "place.yaml"
    place.write_text(f"name: place\nsystem: gnss\nstart: {start}\n")
    wheels = [[k / 10, 1.0, 1.0] for k in range(51)]
    fixes = [[0.5 * k, 7.0 + k / 2, 3.0] for k in range(1, 10)]
    folder = lay(tmp_path / "log", **{"wheelspeeds.csv": table("t,vl,vr", wheels),
                                      "gnss.csv": table("t,x,y", fixes)})  # fmt: skip
    found = read_scene(resolve("gnss_log", "commands"), place, folder)
    ours, (t, pose) = found.get(), begins
    assert ours.log.entries[0].t == t
    mean = ours.world.layout.pose(ours.log.first.mean)
    np.testing.assert_allclose(mean, pose, atol=0.2 if t == 0.5 else 0)
    told = " ".join(found.warnings)
    assert (f"not at the start of {place}, which the fixes do not bear out" in told) == (t == 0.5)


def test_an_antenna_ahead_of_the_robot_is_not_where_the_robot_is(tmp_path):
    """2 m ahead on a robot that looks north: it starts 2 m south of its first fix, sideways as
    unsure as its heading is over the arm: σ² + (2 σ_θ)².
    """
    wheels = [[k / 10, 1.0, 1.0] for k in range(51)]
    fixes = [[0.2 * k, 5.0, 7.0 + k / 5] for k in range(1, 20)]
    folder = lay(tmp_path / "log", **{"wheelspeeds.csv": table("t,vl,vr", wheels),
                                      "gnss.csv": table("t,x,y", fixes)})  # fmt: skip
    mean, P = read(
        "gnss", folder, world("gnss", instruments=(Gnss(mount=Mount(2.0, 0.0, 0.0)),))
    ).log.first
    np.testing.assert_allclose(mean[1:], [math.pi / 2, 5.0, 5.2], atol=0.03)
    across, along, turn = P[2, 2], P[3, 3], P[1, 1]
    assert across == pytest.approx(0.15**2 + 4 * turn, rel=1e-3)
    assert along == pytest.approx(0.15**2, rel=1e-2)
    assert P[1, 2] == pytest.approx(2 * turn, rel=1e-3)  # turned left, the robot is farther right


def test_the_mower_of_the_document_needs_no_truth(tmp_path):
    """Turned by any angle and moved to a map's grid: 0.09 m, where 0.085 m are right with the true
    start, and the raw fixes err by 0.198 m.
    """
    folder = shared("mower_gnss")
    truth = np.loadtxt(folder / "groundtruth-1.csv", delimiter=",", skiprows=1)
    fixes = np.loadtxt(folder / "gnss-1.csv", delimiter=",", skiprows=1)
    for turn in (0.0, 2.0):
        c, s = math.cos(turn), math.sin(turn)
        turned = np.column_stack(
            [fixes[:, 0], fixes[:, 1:] @ [[c, s], [-s, c]] + [[5e5, 5.5e6]]]
        ).tolist()
        files = {"gnss.csv": table("t,x,y", turned),
                 "wheelspeeds.csv": (folder / "wheelspeeds-1.csv").read_text()}  # fmt: skip
        steps, _, _ = steps_of("gnss", lay(tmp_path / f"log{turn}", **files))
        places = {step.entry.t: step.posterior.mean[2:] for step in steps if step.entry.t > 2.105}
        true = truth[np.searchsorted(truth[:, 0], np.array(list(places)) - 1e-9)]
        off = np.array(list(places.values())) - true[:, 1:3] @ [[c, s], [-s, c]] - [5e5, 5.5e6]
        assert np.sqrt(np.mean(np.sum(off**2, axis=1))) == pytest.approx(0.0875, abs=5e-4)
