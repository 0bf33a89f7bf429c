"""KEY=VALUE overrules a number of a world or commands file, and all checks of the file hold for
it."""

import math

import pytest

from ekfsim.errors import InputError, UsageError
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.settings import setting, swept
from ekfsim.systems.faults import SensorFaults
from ekfsim.systems.instruments import Infrared

WORLD = """\
name: lab
boundary: [[-5, -5], [5, -5], [5, 5], [-5, 5]]
start: {x: 1, y: 0, theta: 30}
noise:
  executionDstSigmaRatio: 0.05
  executionAngSigmaRatio: 0.05
  odometryDstSigmaRatio: 0.05
  odometryAngSigmaRatio: 0.05
  rangeSigmaRatio: 0.01
"""
COMMANDS = "world: world.yaml\ngate: 0.9\ncommands: [move: {distance: 1, angle: 0}]\n"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "world.yaml").write_text(WORLD)
    (tmp_path / "commands.yaml").write_text(COMMANDS)
    return tmp_path


def scene(*settings):
    return read_scene("commands.yaml", settings=[setting(text) for text in settings]).get()


def test_a_number_of_the_noise_reaches_the_filter_unless_belief_pins_it(place):
    world = scene("noise.rangeSigmaRatio=0.3").world
    assert (world.noise.range, world.told.noise.range) == (0.3, 0.3)
    (place / "world.yaml").write_text(f"{WORLD}belief: {{noise: {{rangeSigmaRatio: 0.02}}}}\n")
    world = scene("noise.rangeSigmaRatio=0.3", "noise.odometryAngSigmaRatio=0.2").world
    assert (world.noise.range, world.told.noise.range) == (0.3, 0.02)
    assert (world.noise.odometry_angle, world.told.noise.odometry_angle) == (0.2, 0.2)
    world = scene("belief.noise.rangeSigmaRatio=0.4").world
    assert (world.noise.range, world.told.noise.range) == (0.01, 0.4)


def remarks(*settings):
    return read_scene("commands.yaml", settings=[setting(text) for text in settings]).warnings


def test_a_number_that_belief_pins_is_not_changed_for_the_filter_in_silence(place):
    (place / "world.yaml").write_text(
        f"{WORLD}belief: {{noise: {{rangeSigmaRatio: 0.02}}, start: {{x: 0, y: 0, theta: 0}}, "
        f"sigma: {{x: 1}}}}\n"
    )
    assert remarks("noise.rangeSigmaRatio=0.3", "noise.odometryAngSigmaRatio=0.2", "gate=0.5") == [
        "noise.rangeSigmaRatio: only the truth changes, the filter goes on believing 0.02: the "
        "world file has "
        "'belief.noise.rangeSigmaRatio'; set that as well"
    ]
    assert remarks("noise.rangeSigmaRatio=0.3", "belief.noise.rangeSigmaRatio=0.3") == []
    assert [
        line.partition(":")[0]
        for line in remarks("start.x=2", "start.sigma.x=2", "start.sigma.y=2")
    ] == [
        "start.x",
        "start.sigma.x",
    ]


def test_a_warning_about_a_setting_is_told_by_it():
    assert remarks("start.theta=1.5708") == [
        "--set start.theta=1.5708: 1.5708 looks like radians; angles are in degrees: write 90"
    ]


def test_what_a_file_does_not_name_starts_from_its_default():
    world = scene(
        "faults.rangeBias=0.1", "belief.start.theta=40", "start.sigma.y=0.2", "belief.sigma.x=0.3"
    ).world
    assert (world.faults.range_bias, world.faults.range_scale) == (0.1, 1.0)
    assert world.told.start == pytest.approx([1.0, 0.0, math.radians(40)])
    assert world.start == pytest.approx([1.0, 0.0, math.radians(30)])
    assert world.start_sigma.tolist() == [0.0, 0.2, 0.0]
    assert world.told.sigma.tolist() == [0.3, 0.2, 0.0]


def test_a_start_that_is_set_is_believed_too():
    world = scene("start.x=2.5", "belief.start.y=1").world
    assert world.start[:2].tolist() == [2.5, 0.0]
    assert world.told.start[:2].tolist() == [2.5, 1.0]


def test_gate_and_guard_belong_to_the_commands():
    assert (scene().gate, scene("gate=0.5").gate, scene("gate=off").gate) == (0.9, 0.5, None)
    assert scene("guard=skip").guard == "skip"
    assert scene("guard=skip", "gate=off").settings == ("guard=skip", "gate=off")


def test_values_are_yaml():
    assert scene("noise.rangeSigmaRatio=1e-3").world.noise.range == 0.001
    with pytest.raises(UsageError, match="'yes' is text where a number belongs"):
        scene("noise.rangeSigmaRatio=yes")


def test_an_alias_changes_in_one_place_alone(place):
    (place / "world.yaml").write_text(
        WORLD.replace("start: {", "start: &pose {") + "belief: {start: *pose}\n"
    )
    world = scene("belief.start.x=2").world
    assert (world.start[0], world.told.start[0]) == (1.0, 2.0)


def test_the_numbers_of_other_systems(place):
    (place / "world.yaml").write_text(
        "name: cellar\nsystem: pioneer\nboundary: [[0, 0], [4, 0], [4, 4], [0, 4]]\nstart: {x: 1, "
        "y: 1, theta: 0}\n"
    )
    (place / "commands.yaml").write_text("world: world.yaml\ndrive: {path: square, side: 1}\n")
    plain, made = scene().world, scene("robot.rate=7", "sensors.infrared.rate=3").world
    assert (made.robot.rate, made.robot.width) == (7, plain.robot.width)
    assert [type(one) for one in made.instruments] == [type(one) for one in plain.instruments]
    assert [one.rate for one in made.instruments if isinstance(one, Infrared)] == [3]
    assert made.instruments[0] == plain.instruments[0]
    with pytest.raises(
        UsageError,
        match=r"--set sensors.markers.rate=3: the world has no sensor 'markers'; it has: ",
    ):
        scene("sensors.markers.rate=3")
    with pytest.raises(
        UsageError, match=r"--set robot.turnDensity=3: the robot of the system 'pioneer' has no key"
    ):
        scene("robot.turnDensity=3")
    with pytest.raises(
        UsageError,
        match=r"--set noise.rangeSigmaRatio=3: the noise ratios belong to the classroom's",
    ):
        scene("noise.rangeSigmaRatio=3")


MOWER = (
    "name: course\nsystem: mower\nlandmarks: [{id: 0, x: 5, y: 1}]\nstart: {x: 0, y: 0, theta: 0}\n"
)


@pytest.fixture
def course(place):
    def written(more="", way="drive: {path: circle, radius: 3}\n"):
        (place / "world.yaml").write_text(MOWER + more)
        (place / "commands.yaml").write_text(f"world: world.yaml\n{way}")

    return written


def test_a_number_of_a_driven_robot_moves_truth_and_filter_unless_belief_pins_it(course):
    course()
    world = scene("robot.wheelSigma=0.03", "sensors.markers.azimuthSigma=9").world
    assert (world.robot.wheel_sigma, world.told_robot.wheel_sigma) == (0.03, 0.03)
    assert (
        world.told_instruments[0].azimuth_sigma
        == world.instruments[0].azimuth_sigma
        == math.radians(9)
    )
    course("belief: {robot: {wheelSigma: 0.02}, sensors: {markers: {azimuthSigma: 5}}}\n")
    world = scene(
        "robot.wheelSigma=0.03", "robot.headingSigma=2", "sensors.markers.azimuthSigma=9"
    ).world
    assert (world.robot.wheel_sigma, world.told_robot.wheel_sigma) == (0.03, 0.02)
    assert world.told_robot.heading_sigma == world.robot.heading_sigma == math.radians(2)
    assert [i.azimuth_sigma for i in (*world.instruments, *world.told_instruments)] == [
        math.radians(9),
        math.radians(5),
    ]
    assert remarks(
        "robot.wheelSigma=0.03", "robot.headingSigma=2", "sensors.markers.azimuthSigma=9"
    ) == [
        "robot.wheelSigma: only the truth changes, the filter goes on believing 0.02: the world "
        "file has "
        "'belief.robot.wheelSigma'; set that as well",
        "sensors.markers.azimuthSigma: only the truth changes, the filter goes on believing 5: "
        "the world file has "
        "'belief.sensors.markers.azimuthSigma'; set that as well",
    ]


def test_belief_and_faults_of_a_driven_robot_are_set_key_by_key(course):
    course("belief: {robot: {wheelSigma: 0.02}}\n")
    world = scene(
        "belief.robot.headingSigma=1", "belief.sensors.markers.height=1", "faults.gyroBias=3",
        "faults.leftScale=1.1",
        "faults.sensors.markers.elevationBias=2", "faults.sensors.markers.delay=0.5",
        "faults.sensors.markers.outliers=1",
    ).world  # fmt: skip
    assert (world.robot.heading_sigma, world.told_robot.heading_sigma) == (
        math.sqrt(7.62e-5),
        math.radians(1),
    )
    assert (world.instruments[0].height, world.told_instruments[0].height) == (0.226, 1)
    faults = world.drive_faults
    assert (faults.left_scale, faults.right_scale, faults.gyro_bias) == (1.1, 1, math.radians(3))
    assert faults.sensors == {"markers": SensorFaults((0, math.radians(2)), 1, 10, 0.5)}
    for wrong, told in (
        (
            "faults.yawBias=1",
            "the robot of the system 'mower' has no fault 'yawBias'; it may have: leftScale",
        ),
        ("faults.gyroBais=1", r"unknown key 'gyroBais'; did you mean 'faults.gyroBias'\?"),
        ("belief.sensors.gnss.sigma=1", "the world has no sensor 'gnss'; it has: markers"),
        ("belief.robot.rate=1", "unknown key 'rate'"),
    ):
        with pytest.raises(UsageError, match=f"--set {wrong}: {told}"):
            scene(wrong)


def test_on_a_log_what_is_said_of_the_robot_is_what_the_filter_is_told(course, place):
    """Also where the world tells apart what is true of a simulation: a recording has no other
    truth."""
    row = " ".join(["1", "0", "{}", "0.01", "0.01", *["0"] * 16])
    (place / "log").mkdir()
    (place / "log/a-poselog.txt").write_text("".join(row.format(n / 100) + "\n" for n in range(5)))
    (place / "log/a-angles.txt").write_text("0.02 0 0.1 -0.05\n")
    (place / "log/a-map.txt").write_text("0 5 1\n")
    course("belief: {robot: {headingSigma: 0.5}, sensors: {markers: {azimuthSigma: 5}}}\n",
           "recording: {format: mower, path: log}\n")  # fmt: skip

    def told(*settings):
        assert remarks(*settings) == []
        played = scene(*settings)
        assert played.settings == settings
        _, motion, *_, sight, _, _ = (entry.given for entry in played.log.entries)
        return math.degrees(math.sqrt(motion.motion.process[2, 2])), math.degrees(
            sight.sensor.azimuth_sigma
        )

    assert told() == pytest.approx((0.5, 5))
    assert told("robot.headingSigma=2", "sensors.markers.azimuthSigma=3") == pytest.approx((2, 3))
    assert told(
        "belief.robot.headingSigma=2", "belief.sensors.markers.azimuthSigma=3"
    ) == pytest.approx((2, 3))
    assert told("belief.robot.headingSigma=2", "robot.headingSigma=4") == pytest.approx((2, 5))
    assert remarks("robot.headingSigma=2", "faults.leftScale=2") == [
        "--set faults.leftScale=2: nothing changes: a recorded log holds its own faults"
    ]


def test_two_mistakes_are_two_lines():
    with pytest.raises(UsageError) as told:
        scene("noise.rangeSigmaRatio=-3", "guard=hop", "faults.shortReturns=0.1")
    assert str(told.value).splitlines() == [
        "--set guard=hop: 'hop' is not known here; write off, warn or skip",
        "--set noise.rangeSigmaRatio=-3: -3 is negative; write a number of 0 or more",
    ]


def test_a_mistake_of_the_file_itself_is_told_as_that(place):
    (place / "world.yaml").write_text(WORLD.replace("0.01", "-1"))
    with pytest.raises(
        InputError, match=r"^world.yaml:9:20: noise.rangeSigmaRatio: -1 is negative"
    ):
        scene("noise.rangeSigmaRatio=0.1")


@pytest.mark.parametrize("text", ["", "=", "=1", "gate=", "gate", " = "])
def test_what_is_no_setting(text):
    with pytest.raises(UsageError, match="this is no KEY=VALUE"):
        setting(text)


def test_a_sweep_has_its_values_in_order():
    assert [str(one) for one in swept(" gate = off , 0.5,0.9")] == [
        "gate=off",
        "gate=0.5",
        "gate=0.9",
    ]
    for text in ("gate=0.5,,0.6", "gate=", "gate=0.5,"):
        with pytest.raises(UsageError, match="this is no KEY=VALUE,VALUE,…"):
            swept(text)
