"""Bags as recorders leave them: late, unstamped, packed, without definitions, of own types."""

import math
import shutil
import sqlite3
import sys

import numpy as np
import pytest
from bags import LAT, LON, Messages, namespace, written
from click.testing import CliRunner
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import get_types_from_msg
from test_bags import BEGIN, WAY, WORLD, degrees, drive, given, scene

from ekfsim.cli import ekfsim
from ekfsim.errors import InputError, UsageError
from ekfsim.files.logs.bags.fixes import fixes_of
from ekfsim.files.logs.bags.marks import marks_in
from ekfsim.files.logs.bags.odometry import poses_of, tells_speeds
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import posed
from ekfsim.localization import play
from ekfsim.records import Reading

MARKS = {7: (4.0, 1.0), 12: (3.0, -2.0)}  # m
OWN = """std_msgs/Header header
Seen[] markers
================================================================================
MSG: course_msgs/Seen
uint32 id
geometry_msgs/Pose pose
"""


def same(found, other):
    assert len(found) == len(other)
    for (t, number), (at, like) in zip(found, other, strict=True):
        assert t == pytest.approx(at, abs=1e-9)
        np.testing.assert_allclose(number, like, atol=1e-12)


def test_the_order_of_messages_and_when_they_were_received_say_nothing(tmp_path):
    rows = drive("mcap")
    plain = scene(written("mcap", tmp_path / "plain", rows), topics={"truth": "/truth"})
    rng = np.random.default_rng(4)
    late = [(rows[i][0], BEGIN + rng.uniform(0, 9), rows[i][2]) for i in rng.permutation(len(rows))]
    found = scene(written("mcap", tmp_path / "late", late), topics={"truth": "/truth"})
    same(given(found.log), given(plain.log))
    ends = [list(play(one))[-1].posterior for one in (found, plain)]
    np.testing.assert_allclose(ends[0].mean, ends[1].mean, atol=1e-12)
    np.testing.assert_allclose(ends[0].covariance, ends[1].covariance, atol=1e-12)


def test_messages_that_came_twice_count_once(tmp_path):
    rows = drive("mcap")
    plain = scene(written("mcap", tmp_path / "plain", rows))
    twice = [(topic, t + late, message) for topic, t, message in rows for late in (0, 0.3)]
    same(given(scene(written("mcap", tmp_path / "twice", twice)).log), given(plain.log))


def test_fixes_far_from_the_origin_are_told_of():
    make = Messages("db3")
    found = fixes_of([(0, make.fix(0, LAT + 1, LON))], (LAT, LON))
    assert "a fix lies 111 km from there" in "".join(found.told)
    assert "km from there" not in "".join(fixes_of([(0, make.fix(0, LAT, LON))], None).told)


def test_messages_without_a_stamp_count_when_they_were_received(tmp_path):
    make = Messages("bag")
    rows = [(topic, t, message) for topic, t, message in drive("bag") if topic != "/odom"]
    odometry = [("/odom", BEGIN + k * 0.5, make.odometry(0, *pose)) for k, pose in enumerate(WAY)]
    with pytest.warns(UserWarning, match="5 of 5 messages have no stamp"):
        found = scene(written("bag", tmp_path / "b", [*rows, *odometry]))
    same(given(found.log), given(scene(written("bag", tmp_path / "c", drive("bag"))).log))


@pytest.mark.parametrize("packed", ["bz2", "lz4", "file", "message", "bare", "no definitions"])
def test_packed_bags_and_those_without_definitions(tmp_path, monkeypatch, packed):
    kind = "bag" if packed in ("bz2", "lz4") else "db3"
    plain = scene(written(kind, tmp_path / "plain", drive(kind)))
    if kind == "bag":
        monkeypatch.setattr(
            "bags.Writer1", packer(Writer1, Writer1.CompressionFormat[packed.upper()])
        )
    elif packed in ("file", "message"):
        mode = CompressionMode[packed.upper()]
        monkeypatch.setattr("bags.Writer2", packer(Writer2, mode, CompressionFormat.ZSTD))
    path = written(kind, tmp_path / "b", drive(kind))
    if packed == "bare":
        shutil.move(path / "b.db3", tmp_path / "alone.db3")
        path = tmp_path / "alone.db3"
    elif packed == "no definitions":
        base = sqlite3.connect(path / "b.db3")
        assert base.execute("DELETE FROM message_definitions").rowcount > 0
        base.commit()
        base.close()
    same(given(scene(path).log), given(plain.log))


def packer(kind, *how):
    """A writer that packs."""

    def made(*args, **keys):
        writer = kind(*args, **keys)
        writer.set_compression(*how)
        return writer

    return made


def test_landmarks_in_messages_of_ones_own_make(tmp_path):
    make = Messages("mcap")
    make.store.register(get_types_from_msg(OWN, "course_msgs/msg/SeenArray"))
    rows = [row for row in drive("mcap") if row[0] == "/odom"]
    for k, (x, y, θ) in enumerate(WAY[1:4], 1):
        seen = []
        for id, (mx, my) in MARKS.items():
            dx, dy = mx - x, my - y
            ahead = dx * math.cos(θ) + dy * math.sin(θ)
            left = dy * math.cos(θ) - dx * math.sin(θ)
            pose = make.pose(-left, 0.3, 0)  # to the right, down, ahead, as a camera's optics
            pose.position.z = ahead
            seen.append(make.make("course_msgs/msg/Seen", id=id, pose=pose))
        header = make.header(BEGIN + k * 0.5, "camera_optical_frame")
        message = make.make("course_msgs/msg/SeenArray", header=header, markers=seen)
        rows.append(("/seen", BEGIN + k * 0.5 + 0.1, message))
    path = tmp_path / "b"
    with Writer2(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        known = {}
        for topic, t, message in rows:
            name = message.__msgtype__
            if topic not in known:
                known[topic] = writer.add_connection(topic, name, typestore=make.store)
            raw = make.store.serialize_cdr(message, name)
            writer.write(known[topic], round(t * 1e9), raw)
    world = {
        "name": "marks",
        "system": "landmarks",
        "start": {"x": 0, "y": 0, "theta": math.degrees(0.5)},
        "landmarks": [{"id": id, "x": x, "y": y} for id, (x, y) in MARKS.items()],
        "sensors": [{"rangeBearing": {}}],
    }
    recording = {"format": "bag", "path": str(path), "topics": {"landmarks": "/seen"}}
    found = load_scene({"recording": recording}, world)
    readings = [entry for entry in found.log.entries if isinstance(entry.given, Reading)]
    assert len(readings) == 6
    for entry in readings:
        pose = np.array(WAY[round((entry.t - BEGIN) / 0.5)])
        np.testing.assert_allclose(entry.given.z, entry.given.sensor.h(pose), atol=1e-6)


def test_poses_and_speeds_of_other_types_tell_the_same_motion(tmp_path):
    make = Messages("db3")
    poses = scene(written("db3", tmp_path / "odometry", drive("db3")))
    rows = [row for row in drive("db3") if row[0] == "/gps/fix"]
    stamped = [("/p", BEGIN, make.stamped(BEGIN + k * 0.5, *pose)) for k, pose in enumerate(WAY)]
    found = scene(written("db3", tmp_path / "poses", [*rows, *stamped]), topics={"motion": "/p"})
    same(given(found.log), given(poses.log))
    speeds = []
    for k in range(5):
        told = make.odometry(BEGIN + k * 0.5, v=0.4, ω=0.2)
        bare = make.make(
            "geometry_msgs/msg/TwistStamped", header=told.header, twist=told.twist.twist
        )
        speeds.append(("/v", BEGIN, bare))
    found = scene(written("db3", tmp_path / "speeds", [*rows, *speeds]), topics={"motion": "/v"})
    moved = sum(u[:2] for _, u in given(found.log) if len(u) == 3)
    np.testing.assert_allclose(moved, [0.8, 0.4], atol=1e-9)


def test_what_an_odometry_tells_its_motion_by():
    make = Messages("mcap")
    turning = [(k, make.odometry(k, 0, 0, 0.1 * k)) for k in range(4)]
    assert not tells_speeds(turning)  # on the spot
    still = [(k, make.odometry(k, 1, 2, 0.5, v=1)) for k in range(4)]
    assert tells_speeds(still)
    headless = [(k, make.odometry(k, k, 0, 0, v=1)) for k in range(4)]
    for _, message in headless:
        message.pose.pose.orientation.w = 0.0
    assert tells_speeds(headless)


@pytest.mark.parametrize("v", [0.0, 1.0])
def test_a_pose_that_jumps_is_no_way(v):
    """v : m/s that the odometry tells beside its poses, if it does"""
    make, second = Messages("mcap"), 10**9
    ways = [*(k * 0.1 for k in range(100)), *(k * 0.1 for k in range(50))]
    rows = [(k * second // 10, make.odometry(k / 10, x, v=v)) for k, x in enumerate(ways)]
    found = poses_of(rows[::-1])
    steps = np.diff([row[1] for row in found.rows])
    assert steps[99] == pytest.approx(0.1 * v)
    np.testing.assert_allclose(np.delete(steps, 99), 0.1)
    assert "its pose jumps by 9.9 m" in found.told[0]
    assert poses_of(rows[:100]).told == []


@pytest.mark.parametrize("held", [None, False])
def test_equal_fixes_tell_no_course(tmp_path, held):
    make = Messages("db3")
    fixes = [("/fix", BEGIN, make.fix(BEGIN + k * 0.3, LAT, LON)) for k in range(6)]
    rows = [("/odom", BEGIN, make.odometry(BEGIN + k * 0.5, 1, 0, 0)) for k in range(5)]
    path = written("db3", tmp_path / "b", [*rows, *fixes])
    topics = {"fix": {"topic": "/fix"} | ({} if held is None else {"held": held})}
    recording = {"format": "bag", "path": str(path), "topics": topics}
    with pytest.warns(UserWarning, match="its heading (unknown|hardly told)"):
        found = load_scene({"recording": recording})
    readings = sum(isinstance(entry.given, Reading) for entry in found.log.entries)
    assert readings == (0 if held is None else 5)  # beside the first, at which it starts
    first = next(iter(play(found)))
    assert math.sqrt(posed(first.posterior, found.world.layout).covariance[2, 2]) > 1.5


def test_lists_of_ids_and_poses_and_marks_of_the_ground():
    make = Messages("db3")
    at = namespace(position=namespace(x=3.0, y=4.0, z=0.0))
    aruco = namespace(header=make.header(5, "camera_link"), marker_ids=[3, 4], poses=[at, at])
    assert [row[1:3] for row in marks_in([(0, aruco)]).rows] == [("3", 5.0), ("4", 5.0)]
    moved = namespace(translation=namespace(x=0.0, y=2.0, z=9.0))
    fiducial = namespace(fiducial_id=9, transform=moved)
    array = namespace(header=make.header(5, "base"), transforms=[fiducial])
    assert marks_in([(7, array)]).rows == [(7, "9", 2.0, pytest.approx(math.pi / 2))]
    late = namespace(id=1, header=make.header(6, "base"), pose=at)
    assert marks_in([(7, namespace(markers=[late]))]).rows[0][0] == 6 * 10**9
    ground = namespace(header=make.header(5, "map"), marker_ids=[3], poses=[at])
    assert "in a frame of the ground" in marks_in([(0, ground)]).told[0]


def test_two_receivers_share_an_origin(tmp_path):
    make = Messages("mcap")
    rows = [row for row in drive("mcap") if row[0] == "/odom"]
    for k, name in ((1, "/left"), (2, "/right")):
        fix = make.fix(BEGIN + k * 0.5, *degrees(3.0 * k, 1.0))
        rows.append((name, BEGIN + k * 0.5, fix))
    world = {**WORLD, "sensors": [{"gnss": {"name": "a"}}, {"gnss": {"name": "b"}}]}
    topics = {"fix": [{"topic": "/left", "sensor": "a"}, {"topic": "/right", "sensor": "b"}]}
    path = written("mcap", tmp_path / "b", rows)
    recording = {"format": "bag", "path": str(path), "topics": topics}
    log = load_scene({"recording": recording}, world).log
    fixes = [e.given for e in log.entries if isinstance(e.given, Reading)]
    assert [fix.name for fix in fixes] == ["a", "b"]
    np.testing.assert_allclose([fix.z for fix in fixes], [(0, 0), (3, 0)], atol=1e-5)


# rosbags 0.11.0 leaves a broken file open
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_what_is_refused(tmp_path, monkeypatch):
    path = written("mcap", tmp_path / "b", drive("mcap"))
    with pytest.raises(UsageError, match="a bag tells times in ns and angles in rad"):
        scene(path, timeUnit="ms")
    cut = tmp_path / "cut.mcap"
    cut.write_bytes((path / "b.mcap").read_bytes()[:-100])
    with pytest.raises(UsageError, match="one that was cut off is mended by `mcap recover`"):
        scene(cut)
    make = Messages("mcap")
    nowhere = [("/odom", BEGIN + k, make.odometry(BEGIN + k, math.nan)) for k in range(5)]
    with pytest.raises(InputError, match="all 5 rows are left out: not all of the motion stands"):
        scene(written("mcap", tmp_path / "nan", nowhere))
    monkeypatch.setitem(sys.modules, "rosbags.highlevel", None)
    with pytest.raises(UsageError, match=r"pip install 'ekfsim\[bags\]'"):
        scene(path)


@pytest.mark.parametrize(
    ("written", "told"),
    [
        ({}, "fix.topic: the key is missing; write topic:"),
        ([], "fix: an empty list stands here"),
        (["/a"], r"fix\[0\]: '/a' is text where a topic of a sensor belongs"),
        ({"topik": "/a"}, "fix: unknown key 'topik'; did you mean 'topic'"),
        ({"topic": 3}, "fix.topic: 3 is a number where text belongs"),
        ([{"topic": "/a", "held": "no"}], r"fix\[0\].held: 'no' is text where true or false"),
        (3, "fix: 3 is a number where a topic, or {topic: …, sensor: …}, or a list of those"),
    ],
)
def test_a_topic_that_is_written_wrong_is_told_at_its_place(written, told):
    with pytest.raises(InputError, match=rf"recording.topics.{told}"):
        scene("nowhere.bag", topics={"fix": written})


def test_a_topic_is_set_by_its_name_alone(tmp_path):
    path = written("bag", tmp_path / "b", drive("bag"))
    run = ["run", "bag", "--log", str(path), "-q", "--set", "recording.topics.fix=/gps/fix"]
    told = CliRunner().invoke(ekfsim, run)
    assert told.exit_code == 0, told.output
    assert "motion inputs and 2 readings" in told.output
    wrong = CliRunner().invoke(ekfsim, [*run[:-1], "recording.topics.fix=/gps"])
    assert "topics.fix: there is no topic '/gps'; did you mean '/gps/fix'?" in str(wrong.exception)
