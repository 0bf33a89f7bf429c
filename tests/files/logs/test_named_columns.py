"""What the columns of a log of anybody's make may be: wheels, poses, beams, words, units, several
sensors of one kind."""

import math

import numpy as np
import pytest
from log_worlds import errors, lay, table
from test_named_logs import CORNERS, arc, chords, perfect, scene_of

from ekfsim.errors import UsageError
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import load_scene, read_scene
from ekfsim.files.scenes.settings import setting
from ekfsim.localization import play
from ekfsim.records import Control, Reading

HEAD = "name: w\nsystem: {}\nstart: {{x: 2, y: 1, theta: 0}}\n"
BY_LANDMARKS = HEAD.format("landmarks") + "sensors: [rangeBearing: {}]\n"


def laid(folder, motion, readings, landmarks=CORNERS, **more):
    """A log in a folder."""
    files = {"motion.csv": motion, "readings.csv": readings, **more}
    return lay(folder / "log", **files, **({"landmarks.csv": landmarks} if landmarks else {}))


def inputs_of(scene):
    return np.array([e.given.u for e in scene.log.entries if isinstance(e.given, Control)])


def readings_of(scene):
    return [e.given for e in scene.log.entries if isinstance(e.given, Reading)]


RECORDING = "  format: log\n  path: log\n"
WHEELS = "  motion: {width: 0.4}\n"


@pytest.mark.parametrize("unit", ["m", "m/s", "cm"])
def test_wheels_are_speeds_or_ways_as_their_unit_says(unit, tmp_path):
    """A turn is the difference of the wheels by the way between them."""
    poses = arc()
    d, T = chords(poses).T
    scale = {"m": 1, "m/s": 1 / 0.25, "cm": 100}[unit]
    wheels = np.column_stack([d - 0.2 * T, d + 0.2 * T]) * scale
    rows = np.column_stack([poses[:, 0], np.vstack([0 * wheels[:1], wheels])])
    motion = table(f"t,left [{unit}],right [{unit}]", rows.tolist())
    laid(tmp_path, motion, perfect(poses))
    scene = scene_of(tmp_path, BY_LANDMARKS, RECORDING + WHEELS)
    expected = np.column_stack([d / 0.25, T / 0.25, np.full(len(d), 0.25)])
    np.testing.assert_allclose(inputs_of(scene), expected, rtol=1e-12)
    assert max(step.correction.nis for step in play(scene) if step.correction) < 1e-20


def test_wheels_make_no_turn_while_their_distance_is_unknown(tmp_path):
    laid(tmp_path, "t,left,right\n0,0,0\n1,1,1\n", "t,target,range,bearing\n1,1,1,1\n")
    with pytest.raises(UsageError, match="write it into the recording as motion: "):
        scene_of(tmp_path, BY_LANDMARKS, RECORDING)


def test_poses_of_the_odometry_tell_ways_and_turns_in_any_frame(tmp_path):
    """As they are the same from every origin and direction."""
    poses = arc()
    c, s = math.cos(2.5), math.sin(2.5)
    east, north = poses[:, 1] * c - poses[:, 2] * s + 700, poses[:, 1] * s + poses[:, 2] * c - 90
    θ = np.degrees(np.angle(np.exp(1j * (poses[:, 3] + 2.5))))
    rows = np.column_stack([poses[:, 0] * 1e3, east, north, θ])
    motion = table("t_ms,x,y,theta_deg", rows.tolist())
    laid(tmp_path, motion, perfect(poses))
    scene = scene_of(tmp_path, BY_LANDMARKS, RECORDING)
    expected = np.column_stack([chords(poses) / 0.25, np.full(20, 0.25)])
    np.testing.assert_allclose(inputs_of(scene), expected, rtol=1e-9, atol=1e-12)


def test_accelerations_drive_the_inertial_robot_and_no_other(tmp_path):
    motion = "t,ax,ay,yaw\n0.1,0.5,0,0\n0.2,0.4,0.1,0.1\n"
    laid(tmp_path, motion, "t,x,y\n0.2,2,1\n", None)
    place = HEAD.format("pylon") + "sensors: [gnss: {}]\n"
    scene = scene_of(tmp_path, place, RECORDING)
    np.testing.assert_allclose(inputs_of(scene), [[0.5, 0, 0, 0.1], [0.4, 0.1, 0.1, 0.1]])
    with pytest.raises(UsageError, match="cannot be told ax,ay,yaw; it takes t,v,omega or"):
        scene_of(tmp_path, HEAD.format("ranges") + "sensors: [gnss: {}]\n", RECORDING)


def test_beams_among_walls_point_anywhere_and_may_meet_none(tmp_path):
    """Ranges of a room of 6 m by 4 m from its middle, by hand; several beams at one instant."""
    room = HEAD.format("pioneer").replace("x: 2, y: 1", "x: 3, y: 2") + (
        "boundary: [[0, 0], [6, 0], [6, 4], [0, 4]]\n"
        "sensors: [ultrasonic: {range: 10, sigma: 0.02, sigmaPerMetre: 0}]\n"
    )
    beams = [(0, 3.0), (90, 2.0), (-90, 2.0), (30, 2 / math.sin(math.radians(30))), (180, 3.0)]
    rows = [f"0.5,{bearing},{r!r}" for bearing, r in beams if bearing != 30]
    rows += [f"0.5,30,{2 * math.sqrt(3)!r}", "0.5,45,inf", "0.5,60,"]
    motion = "t,distance,turn\n0,0,0\n0.5,0,0\n1,0,0\n"
    laid(tmp_path, motion, "\n".join(["t,bearing_deg,range", *rows, ""]), None)
    scene = scene_of(tmp_path, room, RECORDING)
    steps = [step for step in play(scene) if isinstance(step.entry.given, Reading)]
    used = [step for step in steps if step.correction and not np.isnan(step.correction.nis)]
    assert (len(steps), len(used)) == (7, 5)
    assert max(step.correction.nis for step in used) < 1e-20
    assert [step.entry.given.sensor.bearing for step in used][-1] == pytest.approx(math.pi / 6)
    assert steps[0].entry.given.name == "ultrasonic 0°"


def test_rows_of_several_sensors_stand_in_one_table(tmp_path):
    """Landmarks by their names; an empty field is of no sensor; σ of its own for each fix."""
    poses = arc()
    marks = CORNERS.replace("1,0", "door,0").replace("2,8", "lamp,8")
    dx, dy = 8 - poses[4, 1], 0 - poses[4, 2]
    r, β = float(np.hypot(dx, dy)), float(np.degrees(np.arctan2(dy, dx) - poses[4, 3]))
    fifth, sixth = poses[5:7].tolist()
    readings = (
        "t,sensor,target,range,bearing_deg,x,y,sigma_x,sigma_y\n"
        f"1.0,rangeBearing,lamp,{r!r},{β!r},,,,\n"
        f"1.25,gnss,,,,{fifth[1]!r},{fifth[2]!r},0.5,0.25\n"
        f"1.5,gnss,,,,{sixth[1]!r},{sixth[2]!r},0,0\n"
    )
    rows = np.column_stack([poses[:, 0], np.vstack([0 * poses[:1, :2], chords(poses)])])
    truth = table("t,x,y,theta", poses.tolist())
    motion = table("t,distance,turn", rows.tolist())
    laid(tmp_path, motion, readings, marks, **{"truth.csv": truth})
    place = HEAD.format("ranges") + "sensors: [rangeBearing: {}, gnss: {sigma: 0.7}]\n"
    scene = scene_of(tmp_path, place, RECORDING)
    lamp, fix, unknown = readings_of(scene)
    assert (lamp.sensor.x, lamp.sensor.y) == (8, 0)
    np.testing.assert_allclose(lamp.z, [r, np.radians(β)], rtol=1e-12)
    assert (fix.sensor.sigma_x, fix.sensor.sigma_y) == (0.5, 0.25)
    assert (unknown.sensor.sigma_x, unknown.sensor.sigma_y) == (0.7, 0.7)
    assert max(step.correction.nis for step in play(scene) if step.correction) < 1e-18


def test_two_sensors_of_a_kind_have_their_rates_lever_arms_and_delays(tmp_path):
    """Antennas ahead and behind, one of which tells its fixes half a second late."""
    poses = arc()
    c, s = np.cos(poses[:, 3]), np.sin(poses[:, 3])
    front = np.column_stack([poses[:, 0], poses[:, 1] + 0.5 * c, poses[:, 2] + 0.5 * s])[::2]
    back = np.column_stack([poses[:, 0] + 0.5, poses[:, 1] - 0.3 * c, poses[:, 2] - 0.3 * s])[::5]
    rows = np.column_stack([poses[:, 0], np.vstack([0 * poses[:1, :2], chords(poses)])])
    place = HEAD.format("ranges") + (
        "sensors:\n  - gnss: {name: front, mount: {x: 0.5, y: 0}}\n"
        "  - gnss: {name: back, mount: {x: -0.3, y: 0}, delay: 0.5}\n"
    )
    truth = table("t,x,y,theta", poses.tolist())
    laid(
        tmp_path, table("t,distance,turn", rows.tolist()), table("t,x,y", front[1:].tolist()), None,
        **{"late.csv": table("t,x,y", back[1:].tolist()), "truth.csv": truth},
    )  # fmt: skip
    tables = "  readings: [{sensor: front, file: readings.csv}, {sensor: back, file: late.csv}]\n"
    scene = scene_of(tmp_path, place, RECORDING + tables)
    steps = list(play(scene))
    assert sum(step.correction is not None for step in steps) == 10 + 4
    assert max(step.correction.nis for step in steps if step.correction) < 1e-18
    assert np.abs(errors(steps, scene.world.layout)).max() < 1e-12


def test_a_world_is_made_for_each_sensor_that_a_column_names(tmp_path):
    readings = "t,sensor,target,range,x,y\n1,uwb,1,2,,\n1,gnss,,,2,1\n"
    laid(tmp_path, "t,v,omega\n0,1,0\n1,1,0\n2,1,0\n", readings)
    scene = load_scene("log", log=tmp_path / "log")
    assert [(one.called, one.name) for one in scene.world.instruments] == [
        ("uwb", "range"),
        ("gnss", "gnss"),
    ]


def test_a_column_that_is_told_and_not_there_is_a_mistake(tmp_path):
    laid(tmp_path, "time_ns,v,omega\n0,1,0\n1000000000,1,0\n", "t,target,range,bearing\n0,1,1,1\n")
    with pytest.raises(UsageError) as caught:
        scene_of(tmp_path, BY_LANDMARKS, RECORDING + "  motion: {columns: {t: times}}\n")
    assert str(caught.value).endswith(
        "motion.csv:1:1: columns.t: no column is named 'times'; found 'time_ns', 'v', 'omega'"
    )
    with pytest.raises(UsageError) as caught:
        scene_of(tmp_path, BY_LANDMARKS, RECORDING + "  columns: {bearing: angel}\n")
    assert "recording.columns.bearing: no table of the log has a column 'angel'; found" in str(
        caught.value
    )


def test_columns_of_other_formats_are_their_own(tmp_path):
    (tmp_path / "c.yaml").write_text(
        "world: gnss\nrecording: {format: gnss, path: log, columns: {t: time_ns}}\n"
    )
    (mistake,) = read_scene(tmp_path / "c.yaml").mistakes
    assert mistake.wrong == "a 'gnss' log has columns and files of its own"
    assert mistake.right == "delete it, or write format: log"


def test_motions_and_readings_may_share_the_rows_of_one_file(tmp_path):
    """A row may tell a motion, a reading, or both."""
    text = "t,v,omega,x,y\n0,1,0,,\n0.5,1,0,2.5,1\n0.75,,,2.75,1\n1,1,0,3,1\n"
    lay(tmp_path, **{"all.csv": text, "w.yaml": HEAD.format("ranges") + "sensors: [gnss: {}]\n"})
    (tmp_path / "c.yaml").write_text("world: w.yaml\nrecording: {format: log, path: all.csv}\n")
    start = [setting(f"start.{axis}") for axis in ("x=2", "y=1", "theta=0")]
    found = read_scene(tmp_path / "c.yaml", settings=start)
    steps = list(play(found.get()))
    assert any("no motion stands in this row: left out" in told for told in found.warnings)
    assert [step.entry.t for step in steps if step.correction] == [0.5, 0.75, 1.0]
    assert max(step.correction.nis for step in steps if step.correction) < 1e-3


def test_a_pylon_s_offset_is_read_as_it_is_used(tmp_path):
    motion = "t,ax,ay,yaw\n0.1,0,0,0\n0.2,0,0,0\n"
    laid(tmp_path, motion, "t,target,offset_east,offset_north\n0.2,7,3,-6\n", "id,x,y\n7,5,-5\n")
    place = HEAD.format("pylon") + "sensors: [pylon: {}]\n"
    scene = scene_of(tmp_path, place, RECORDING)
    (seen,) = readings_of(scene)
    assert seen.z.tolist() == [3, -6]
    (step,) = [step for step in play(scene) if step.correction]
    assert np.abs(step.correction.innovation).max() < 1e-12


def told(folder, motion, readings, *settings):
    """The mistakes of a log without a world, or what it is refused with."""
    log = laid(folder, motion, readings, None)
    found = read_scene(resolve("log", "commands"), None, log, settings=[*map(setting, settings)])
    lines = [*map(str, found.mistakes), *([str(found.refusal)] if found.refusal else [])]
    return [line.removeprefix(str(log)).lstrip("/: ") for line in lines]


def test_what_is_wrong_with_a_log_without_a_world_is_told(tmp_path):
    rows, fix = "t,v,omega\n0,1,0\n1,1,0\n", "t,x,y\n1,1,0\n"
    assert told(tmp_path / "a", rows[:16], fix) == [
        "the motion has one instant alone: there is no way to localize on; it needs two rows of "
        "different times"
    ]
    assert told(tmp_path / "b", rows, "t,target,range\n1,7,3\n") == [
        "readings.csv:1:1: the world has no sensor that could see anything, or nothing to be seen; "
        "write landmarks.csv (id,x,y) in the log, or landmarks: and sensors: in the world"
    ]
    odd = rows.replace("omega", "rate")
    (line,) = told(tmp_path / "c", odd, fix)
    assert line.startswith("motion.csv:1:1: no column is named as a motion's are; write t,v,omega")
    assert told(tmp_path / "d", odd, fix, "recording.columns.omega=rate") == []
    (line,) = told(tmp_path / "e", rows, fix, "recording.motion.file=drive.csv")
    assert line == "drive.csv: no such file"


@pytest.mark.parametrize(
    ("head", "factor"),
    [("v_ms", 1.0), ("v [m/s]", 1.0), ("speed (km/h)", 3.6), ("v_cm/s", 100.0), ("v_mm/s", 1e3)],
)
def test_speeds_are_in_what_their_name_says(head, factor, tmp_path):
    """`_ms` behind a speed is m/s, as it is written where no stroke can be; behind a time it is
    milliseconds.
    """
    rows = [[100.0 * k, 0.3 * factor, 0.1] for k in range(5)]
    laid(tmp_path, table(f"t_ms,{head},omega", rows), "t,target,range,bearing\n0.2,1,1,1\n")
    scene = scene_of(tmp_path, BY_LANDMARKS, RECORDING)
    np.testing.assert_allclose(inputs_of(scene)[:, 0], 0.3, rtol=1e-12)
    assert [e.t for e in scene.log.entries][-1] == pytest.approx(0.4)


@pytest.mark.parametrize("point", [".", ","])
def test_tabs_part_names_and_words_that_hold_blanks(point, tmp_path):
    """The same numbers as with commas between the columns, whatever is the decimal point."""
    poses = arc()
    motion = table("t,x,y,theta", poses.tolist())
    readings = perfect(poses)
    laid(tmp_path, motion, readings)
    plain = readings_of(scene_of(tmp_path, BY_LANDMARKS, RECORDING))
    head, *rows = readings.replace(",", "\t").splitlines()
    named = head.replace("range", "range [m]")
    tabs = "\n".join([named, *(row.replace(".", point) for row in rows)]) + "\n"
    laid(tmp_path, motion, tabs)
    read = readings_of(scene_of(tmp_path, BY_LANDMARKS, RECORDING))
    assert len(read) == len(plain) > 0
    np.testing.assert_array_equal([one.z for one in read], [one.z for one in plain])
