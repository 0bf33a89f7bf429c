"""A simulated run, written as a recorded log and read again, gives the numbers of the run
itself."""

from dataclasses import replace

import numpy as np
import pytest
from log_worlds import CLOSET, MARKS, PYLON, read, world

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import read_log, write_log
from ekfsim.localization import play
from ekfsim.records import Control
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.systems.drives import Circle, Square
from ekfsim.systems.instrument import Landmark
from ekfsim.systems.instruments import Compass, Gyro, Infrared, Markers, Ultrasonic
from ekfsim.systems.instruments import Pylon as PylonLidar
from ekfsim.systems.robots import Pioneer, PylonCart

ROUND, AROUND = Circle(radius=3.0, speed=1.0, laps=0.5), Square(side=2.0, speed=1.0)
SCENES = {
    "mower": Scene(world("mower", MARKS, instruments=(Markers(rate=2.0),)), drive=ROUND, seed=4),
    "gnss": Scene(world("gnss"), drive=ROUND, seed=5),
    "pylon": Scene(world("pylon", PYLON), drive=ROUND, seed=6),
    "pioneer": Scene(world("pioneer", floor=CLOSET), drive=AROUND, seed=7),
    "pylon seen now and then": Scene(
        world("pylon", PYLON, instruments=(PylonLidar(rate=3.0),)), drive=ROUND
    ),
    "pylon from elsewhere": Scene(world("pylon", PYLON, start=(2.0, -3.0, 1.0)), drive=ROUND),
    "pylon of another rate": Scene(world("pylon", PYLON, robot=PylonCart(rate=25.0)), drive=ROUND),
    "pioneer's other order": Scene(
        world("pioneer", floor=CLOSET, instruments=(Infrared(), Ultrasonic(rate=1.0))), drive=AROUND
    ),
    "pioneer with a compass and a gyro": Scene(
        world(
            "pioneer",
            floor=CLOSET,
            start=(1, 1, 2.5),
            instruments=(Ultrasonic(), Compass(2, 0.1, 0.7), Gyro()),
        ),
        drive=AROUND,
    ),
    "pioneer by its gyro alone": Scene(
        world("pioneer", floor=CLOSET, instruments=(Gyro(),)), drive=AROUND
    ),
    "pioneer on skids": Scene(
        world("pioneer", floor=CLOSET, robot=Pioneer(odometry="skidSteer")), drive=AROUND
    ),
    "gnss from elsewhere": Scene(world("gnss", start=(2.0, -3.0, 3.0)), drive=ROUND),
}


def again(scene, folder):
    """The scene whose log the folder holds, and the warnings of its reader."""
    found = read_log(RecordingKeys(format=scene.world.system), folder, scene.world, scene.reading)
    place = (
        scene.world if found.landmarks is None else replace(scene.world, landmarks=found.landmarks)
    )
    return replace(scene, world=place, drive=None, log=found.log), found.warnings


@pytest.mark.parametrize("filter", ["ekf", "ukf"])
@pytest.mark.parametrize("name", SCENES)
def test_a_run_and_its_log_give_the_same_numbers(tmp_path, name, filter):
    scene = replace(SCENES[name], filter=filter)
    assert write_log(scene, simulate(scene), tmp_path / "log", force=False, format="own") == []
    logged, warnings = again(scene, tmp_path / "log")
    usual = "did not see the pylon", "no truth tells where it starts: taken is "
    assert [told for told in warnings if not any(words in told for words in usual)] == []
    run, log = list(play(scene)), list(play(logged))
    assert len(run) == len(log)
    assert sum(step.correction is not None for step in run) > 5
    for a, b in zip(run, log, strict=True):
        assert (a.entry.index, type(a.entry.given)) == (b.entry.index, type(b.entry.given))
        assert a.entry.t == pytest.approx(b.entry.t, abs=1e-9)
        np.testing.assert_allclose(b.posterior.mean, a.posterior.mean, rtol=0, atol=1e-9)
        np.testing.assert_allclose(
            b.posterior.covariance, a.posterior.covariance, rtol=0, atol=1e-9
        )
        if a.correction is not None:
            assert a.entry.given.name == b.entry.given.name
            np.testing.assert_allclose(b.correction.nis, a.correction.nis, rtol=1e-7)


@pytest.mark.parametrize("reading", ["printed", "coded"])
@pytest.mark.parametrize("name", ["gnss", "pylon", "pioneer"])
def test_so_they_do_in_every_reading_of_the_document(tmp_path, name, reading):
    scene = replace(SCENES[name], reading=reading)
    assert write_log(scene, simulate(scene), tmp_path / "log", force=False, format="own") == []
    run, log = list(play(scene)), list(play(again(scene, tmp_path / "log")[0]))
    np.testing.assert_allclose(log[-1].posterior.mean, run[-1].posterior.mean, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", ["mower", "gnss", "pioneer"])
def test_the_truth_comes_back(tmp_path, name):
    scene = SCENES[name]
    write_log(scene, simulate(scene), tmp_path / "log", force=False, format="own")
    log = again(scene, tmp_path / "log")[0].log.entries
    for n, (a, b) in enumerate(zip(simulate(scene), log, strict=True)):
        if (name, n) != ("mower", 1):  # its row holds the pose at which the filter starts
            np.testing.assert_allclose(b.truth, a.truth, rtol=0, atol=1e-12)


def test_the_gps_of_a_pylon_log_begins_at_its_first_fix(tmp_path):
    scene = SCENES["pylon"]
    write_log(scene, simulate(scene), tmp_path / "log", force=False, format="own")
    found = read("pylon", tmp_path / "log", scene.world).log.entries
    fixes = [
        np.array([e.fix for e in log if isinstance(e.given, Control)])
        for log in (list(simulate(scene)), found)
    ]
    np.testing.assert_allclose(fixes[1], fixes[0] - fixes[0][0], rtol=0, atol=1e-7)


def test_what_the_files_hold(tmp_path):
    scene = SCENES["mower"]
    write_log(scene, simulate(scene), tmp_path / "log", force=False, format="own")
    folder = tmp_path / "log"
    assert sorted(path.name for path in folder.iterdir()) == [
        *("about.txt", "marker-001-003-angles.txt", "marker-001-map.txt", "marker-001-poselog.txt")
    ]
    poses, angles, marks = (
        np.loadtxt(folder / f"marker-001-{name}.txt") for name in ("poselog", "003-angles", "map")
    )
    assert poses.shape == (len([e for e in simulate(scene) if isinstance(e.given, Control)]), 21)
    assert poses[0, 2] == 0.01
    np.testing.assert_array_equal(poses[0, 18:], scene.world.told.start)
    np.testing.assert_array_equal(marks, MARKS)
    after = np.searchsorted(poses[:, 2], angles[:, 0])
    assert np.all((poses[after - 1, 2] < angles[:, 0]) & (angles[:, 0] < poses[after, 2]))
    assert "seed 4" in (folder / "about.txt").read_text()


def test_markers_are_named_by_the_rows_of_the_map(tmp_path):
    marks = tuple(mark._replace(id=10 * mark.id + 3) for mark in MARKS)
    scene = replace(SCENES["mower"], world=replace(SCENES["mower"].world, landmarks=marks))
    write_log(scene, simulate(scene), tmp_path / "log", force=False, format="own")
    assert set(np.loadtxt(tmp_path / "log" / "marker-001-003-angles.txt")[:, 1]) <= {0, 1, 2, 3}
    logged, warnings = again(scene, tmp_path / "log")
    assert logged.world.landmarks == marks
    assert [told.partition(": ")[2] for told in warnings] == [
        "its ids are not 0, 1, 2, …: the angles name a marker by its row, from 0"
    ]


def test_what_a_log_cannot_hold_is_told(tmp_path):
    place = SCENES["gnss"].world
    elsewhere = replace(place, told=replace(place.told, start=np.array([1.0, 0.0, 0.0])))
    scene = replace(SCENES["gnss"], world=elsewhere)
    assert write_log(scene, simulate(scene), tmp_path / "a", force=False, format="own") == [
        "the filter of this run began otherwise than the log says: its numbers come again only in "
        "a world with the same belief.start and belief.sigma"
    ]
    scene = replace(SCENES["mower"], reading="coded")
    assert write_log(scene, simulate(scene), tmp_path / "b", force=False, format="own") == [
        "the listing begins with the mean heading of the first second: the log's numbers differ "
        "from the run's"
    ]
    with_fixes = replace(
        SCENES["mower"].world, instruments=(*SCENES["mower"].world.instruments, *place.instruments)
    )
    scene = replace(SCENES["mower"], world=with_fixes)
    with pytest.raises(
        UsageError, match="no place for readings of 'gnss'; take that sensor out of the world"
    ):
        write_log(scene, simulate(scene), tmp_path / "c", force=False, format="own")
    assert not (tmp_path / "c").exists()


def test_only_simulated_drives_are_recorded(tmp_path):
    mower = SCENES["mower"]
    landmarks = Scene(world("mrclam", (Landmark(1, 2.0, 2.0),)), drive=ROUND)
    write_log(mower, simulate(mower), tmp_path / "log", force=False, format="own")
    for scene, told in (
        (
            landmarks,
            "--format own: logs of the system 'landmarks' have no format of their own that is "
            "written; write --format log, or leave this out",
        ),
        (
            again(mower, tmp_path / "log")[0],
            "commands: is a recorded log already; name a simulation",
        ),
    ):
        with pytest.raises(UsageError) as refused:
            write_log(scene, iter(()), tmp_path / "out", force=False, format="own")
        assert str(refused.value) == told
