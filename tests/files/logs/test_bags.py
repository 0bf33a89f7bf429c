"""Bags of ROS 1 and 2, and MCAP: what their topics tell is what a log of the same numbers tells."""

import math

import numpy as np
import pytest
from bags import KINDS, LAT, LON, Messages, namespace, written

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.topics import TopicsKeys
from ekfsim.files.logs.bags.fixes import fixes_of
from ekfsim.files.logs.bags.marks import marks_in
from ekfsim.files.logs.bags.scans import beams_of
from ekfsim.files.logs.bags.topics import topics_of
from ekfsim.files.scenes.load import load_scene
from ekfsim.records import Control, Reading

BEGIN = 1_700_000_000.0  # s
WAY = [(0.0, 0.0, 0.5), (0.2, 0.1, 0.6), (0.5, 0.3, 0.9), (0.7, 0.6, 1.1), (0.8, 0.9, 1.3)]
PLACES = [(0.1, 0.0), (0.45, 0.35), (0.85, 0.95)]  # m east and north of the origin
SQUARE = 0.00669437999014  # e² of WGS 84
WORLD = {
    "name": "yard",
    "system": "ranges",
    "start": {"x": 0, "y": 0, "theta": 30},
    "sensors": [{"gnss": {}}],
    "belief": {"start": {"x": 0, "y": 0, "theta": 30}},
}


def degrees(east, north):
    """Latitude and longitude near the origin, by the radii of curvature of the ellipsoid."""
    w = 1 - SQUARE * math.sin(math.radians(LAT)) ** 2
    meridian, across = 6378137 * (1 - SQUARE) / w**1.5, 6378137 / math.sqrt(w)
    lat = LAT + math.degrees(north / meridian)
    return lat, LON + math.degrees(east / (across * math.cos(math.radians(LAT))))


def drive(kind, order=1):
    """A way and three fixes on it, as (topic, when the bag received it, message)."""
    make, out = Messages(kind), []
    for k, pose in enumerate(WAY):
        t = BEGIN + k * 0.5
        out.append(("/odom", t + 0.01, make.odometry(t, *pose)))
        out.append(("/truth", t + 0.03, make.stamped(t, *pose)))
    for k, place in enumerate(PLACES):
        t = BEGIN + 0.5 + k * 0.6
        out.append(("/gps/fix", t + 0.2, make.fix(t, *degrees(*place))))
    return out[::order]


def scene(path, **recording):
    origin = {"latitude": LAT, "longitude": LON}
    keys = {"format": "bag", "path": str(path), "origin": origin, **recording}
    return load_scene({"recording": keys}, WORLD)


def given(log):
    return [
        (entry.t, entry.given.u if isinstance(entry.given, Control) else entry.given.z)
        for entry in log.entries
        if entry.given is not None
    ]


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("kind", KINDS)
def test_a_bag_tells_what_a_log_of_the_same_numbers_tells(tmp_path, kind, order):
    path = written(kind, tmp_path / "b", drive(kind, order))
    poses = "".join(f"{BEGIN + k * 0.5!r},{x},{y},{a}\n" for k, (x, y, a) in enumerate(WAY))
    fixes = "".join(f"{BEGIN + 0.5 + k * 0.6!r},{x},{y}\n" for k, (x, y) in enumerate(PLACES))
    folder = tmp_path / "log"
    folder.mkdir()
    (folder / "motion.csv").write_text(f"t,x,y,theta\n{poses}")
    (folder / "truth.csv").write_text(f"t,x,y,theta\n{poses}")
    (folder / "readings.csv").write_text(f"t,x,y\n{fixes}")
    plain = load_scene({"recording": {"format": "log", "path": str(folder)}}, WORLD)
    found = scene(path, topics={"truth": "/truth"})
    assert len(given(found.log)) == len(given(plain.log)) == 9
    for (t, number), (at, other) in zip(given(found.log), given(plain.log), strict=True):
        assert t == pytest.approx(at, abs=1e-6)
        np.testing.assert_allclose(number, other, atol=1e-6)
    truths = [entry.truth for entry in found.log.entries], [e.truth for e in plain.log.entries]
    np.testing.assert_allclose(*truths, atol=1e-6)
    sensor = next(e.given.sensor for e in found.log.entries if isinstance(e.given, Reading))
    assert (sensor.sigma_x, sensor.sigma_y) == pytest.approx((0.2, 0.3))


def test_speeds_count_where_no_pose_is_told(tmp_path):
    make = Messages("mcap")
    rows = [("/odom", BEGIN + k, make.odometry(BEGIN + k, v=0.5, ω=0.1)) for k in range(4)]
    path = written("mcap", tmp_path / "b", [*rows, *drive("mcap")[-3:]])
    moved = sum(u[:2] for _, u in given(scene(path).log) if len(u) == 3)
    np.testing.assert_allclose(moved, [1.5, 0.3], atol=1e-6)


def test_fixes_that_are_none_are_left_out_and_told():
    make = Messages("db3")
    odd = [
        make.fix(1, LAT, LON, status=-1),
        make.fix(2, math.nan, LON),
        make.fix(3, 0.0, 0.0),
        make.fix(4, LAT, LON, variances=(0, 0), type=0),
        make.fix(5, LAT, LON, variances=(0, 0), type=2),
    ]
    found = fixes_of([(n, fix) for n, fix in enumerate(odd)], None)
    assert [row[0] for row in found.rows] == [3, 4]
    assert all(row[3:] == ("", "") for row in found.rows)
    told = "\n".join(found.told)
    for words in (
        "has no fix",
        "has no number",
        "is at 0°, 0°",
        "true north",
        "tell no covariance",
    ):
        assert words in told


def test_beams_of_a_scan():
    make = Messages("db3")
    ranges = [1.0, math.inf, -math.inf, math.nan, 0.05, 11.0, 7.0, 8.0]
    step = math.pi / 4
    scan = make.scan(0, ranges, first=-math.pi, step=step)
    assert scan.angle_max == pytest.approx(math.pi)  # which no beam has
    bearings = [-math.pi + n * step for n in range(8)]
    echoes = [(0, 1.0), (1, math.inf), (5, math.inf), (6, 7.0), (7, 8.0)]
    assert beams_of(scan, bearings) == [(n, n, r) for n, r in echoes]
    assert beams_of(scan, [math.pi, math.pi / 2 + 0.1 * step]) == [(0, 0, 1.0), (1, 6, 7.0)]
    back = make.scan(0, ranges, first=math.pi, step=-step)
    assert beams_of(back, [math.pi - 6 * step]) == [(0, 6, 7.0)]
    front = make.scan(0, [1.0, 2.0, 3.0], first=-0.1, step=0.1)
    assert beams_of(front, [0.0, 0.3, -0.2]) == [(0, 1, 2.0)]


def test_landmarks_that_a_camera_sees():
    def mark(id, x, y, z, frame):
        pose = namespace(position=namespace(x=x, y=y, z=z))
        return namespace(
            id=id,
            header=namespace(frame_id=frame, stamp=namespace(sec=0, nanosec=0)),
            pose=namespace(pose=pose),
        )

    ahead = namespace(
        markers=[mark(7, 3.0, 4.0, 9.0, "base"), mark(8, -1.0, 9.0, 1.0, "eye_optical")]
    )
    found = marks_in([(5, ahead)])
    assert found.rows == [
        (5, "7", 5.0, pytest.approx(math.atan2(4, 3))),
        (5, "8", pytest.approx(math.sqrt(2)), pytest.approx(math.pi / 4)),
    ]
    assert "'eye_optical' is taken as z ahead, x to the right" in found.told[1]
    on_the_map = namespace(markers=[mark(9, 1.0, 2.0, 0.0, "/map")])
    assert marks_in([(5, on_the_map)]).rows == []


def test_topics_that_are_not_there_or_tell_something_else():
    odometry, fix = "nav_msgs/msg/Odometry", "sensor_msgs/msg/NavSatFix"

    def told(topics, **asked):
        connections = [namespace(topic=a, msgtype=b, msgcount=1) for a, b in topics.items()]
        connections.append(namespace(topic="/silent", msgtype=fix, msgcount=0))
        with pytest.raises(UsageError) as error:
            topics_of(connections, TopicsKeys(**asked), "b.bag", [])
        return str(error.value)

    assert "topics: {motion: /a}" in told({"/a": odometry, "/b": odometry})
    assert "did you mean '/odom'?" in told({"/odom": odometry}, motion="/odmo")
    assert f"'/f' is of the type {fix}" in told({"/f": fix}, motion="/f")
    assert "tells the motion" in told({"/f": fix})
    assert "'/silent' holds no message" in told({"/a": odometry}, fix="/silent")
    pose = {"/p": "geometry_msgs/msg/PoseStamped", "/tf": "tf2_msgs/msg/TFMessage"}
    assert "name one that does: topics: {motion: /p}" in told(pose)


def test_what_is_no_bag(tmp_path):
    (tmp_path / "a.bag").write_bytes(b"#ROSBAG V2.0\nno more")
    for place, words in (
        ("a.bag", "rosbags cannot read it"),
        ("b.bag", "no such file"),
        ("", "a.bag"),
    ):
        with pytest.raises(UsageError, match=words):
            scene(tmp_path / place)
