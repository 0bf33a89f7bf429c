# ruff: noqa: E501 (each message stands whole on its line)
"""The keys of the documents' systems: robot, sensors, drive and recording, their defaults and their
mistakes."""

import dataclasses
import math
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import get_args

import numpy as np
import pytest

from ekfsim.cli.program import options
from ekfsim.errors import InputError, UsageError
from ekfsim.files import keys as all_keys
from ekfsim.files.keys import drive as drive_file
from ekfsim.files.keys import fields
from ekfsim.files.keys.fields import SystemName, aliases, whole
from ekfsim.files.keys.recorded.recording import OF_ANY_ROBOT, SYSTEM_OF, LogFormat
from ekfsim.files.keys.worlds.documents import fields_of, robot_fields
from ekfsim.files.keys.worlds.faults import FaultySensorsKeys
from ekfsim.files.keys.worlds.robot import RobotKeys
from ekfsim.files.keys.worlds.sensors import SENSORS, SensorKeys
from ekfsim.files.keys.worlds.told import ToldSensorsKeys
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.building import instrument_of
from ekfsim.files.scenes.load import check, load_scene, load_world, read_scene
from ekfsim.files.yaml.schema import json_schema
from ekfsim.provenance import provenance
from ekfsim.systems import INSTRUMENTS, SYSTEMS
from ekfsim.systems.document import READINGS
from ekfsim.systems.drives import DRIVES, Circle, Spiral, Square, Stretch, Stretches
from ekfsim.systems.instruments import Gnss, Infrared, Markers, Ranges, Ultrasonic
from ekfsim.systems.robots import Mower, Pioneer
from ekfsim.world import Noise

NOISE = (
    "noise: {executionDstSigmaRatio: 0.05, executionAngSigmaRatio: 0.05, odometryDstSigmaRatio: "
    "0.02, "
    "odometryAngSigmaRatio: 0.02, rangeSigmaRatio: 0.01}\n"
)
HEAD = "name: a\nstart: {x: 1, y: 1, theta: 90}\n"
CLASSROOM = HEAD + NOISE
MOWER = HEAD + "system: mower\nlandmarks: [{id: 1, x: 2, y: 3}]\n"
GNSS = HEAD + "system: gnss\n"
LOGS = Path(__file__).resolve().parents[3] / ".." / "shared" / "data"


@pytest.fixture
def world(tmp_path):
    def load(text):
        (tmp_path / "world.yaml").write_text(text)
        return load_world(tmp_path / "world.yaml")

    return load


@pytest.fixture
def scene(tmp_path):
    def load(text, world=MOWER, **options):
        (tmp_path / "world.yaml").write_text(world)
        (tmp_path / "scene.yaml").write_text("world: world.yaml\n" + text)
        return load_scene(tmp_path / "scene.yaml", **options)

    return load


def test_a_classroom_has_no_robot_of_its_own(world):
    room = world(CLASSROOM)
    assert (room.system, room.robot, room.instruments, room.expected_path) == (
        "classroom",
        None,
        (),
        None,
    )
    assert world(CLASSROOM + "system: classroom\n").system == "classroom"


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_system_is_the_document_s_where_the_file_says_nothing(world, system):
    course = world(HEAD + f"system: {system}\n")
    assert course.robot == SYSTEMS[system].robot
    assert course.instruments == SYSTEMS[system].instruments
    assert course.noise == course.told.noise == Noise(0, 0, 0, 0, 0)
    assert world(HEAD + f"system: {system}\nrobot: {{}}\n").robot == SYSTEMS[system].robot


def test_what_a_file_says_of_a_robot_is_what_it_is(world):
    robot = world(
        MOWER
        + "robot: {rate: 50, width: 2, wheelSigma: 0, positionSigma: 0.1, headingSigma: 180}\n"
    ).robot
    assert robot == Mower(50.0, 2.0, 0.0, 0.1, math.pi)
    robot = world(
        HEAD + "system: pioneer\nrobot: {odometry: skidSteer, skid: [[1, 1], [0, 0], [2, -2]]}\n"
    ).robot
    assert robot == Pioneer(odometry="skidSteer", skid=((1.0, 1.0), (0.0, 0.0), (2.0, -2.0)))


def test_what_a_file_says_of_its_sensors_is_what_they_are(world):
    sensors = world(
        MOWER + "sensors:\n"
        "  - markers: {range: 12, azimuthSigma: 1.8, views: [[-90, 90], [135, 225]]}\n"
        "  - range: {scale: 1, bias: 0}\n"
        "  - gnss: {}\n"
        "  - ultrasonic: {bearings: [-90, 0], sigmaPerMetre: 0.02, range: 3}\n"
        "  - infrared: {colour: black, nearest: 0.2}\n"
    ).instruments
    quarter = math.pi / 2
    assert sensors == (
        Markers(
            farthest=12.0,
            azimuth_sigma=math.pi / 100,
            views=((-quarter, quarter), (1.5 * quarter, 2.5 * quarter)),
        ),
        Ranges(scale=1.0, bias=0.0),
        Gnss(),
        Ultrasonic(bearings=(-quarter, 0.0), sigma_per_metre=0.02, farthest=3.0),
        Infrared(colour="black", nearest=0.2),
    )
    assert world(MOWER + "sensors: []\n").instruments == ()


def test_a_start_and_a_belief_may_be_told_in_every_system(world):
    course = world(GNSS + "belief: {start: {x: 2, y: 3, theta: 0}, sigma: {x: 0.5}}\n")
    np.testing.assert_array_equal(course.told.start, [2, 3, 0])
    np.testing.assert_array_equal(course.told.sigma, [0.5, 0, 0])


def test_the_way_that_was_meant_closes_by_itself(world):
    square = [[0, 0], [10, 0], [10, -10], [0, -10]]
    for points in (square, [*square, square[0]]):
        np.testing.assert_array_equal(
            world(GNSS + f"expectedPath: {points}\n").expected_path, square
        )
    np.testing.assert_array_equal(
        world(CLASSROOM + "expectedPath: [[0, 0], [1, 1]]\n").expected_path, [[0, 0], [1, 1]]
    )


def test_every_key_has_its_part_and_every_part_its_key():
    assert set(get_args(SystemName)) == {"classroom", *SYSTEMS}
    assert set(RobotKeys.model_fields) == {
        name for system in SYSTEMS for name in robot_fields(system)
    }
    assert {field.alias or name for name, field in SensorKeys.model_fields.items()} == set(
        INSTRUMENTS
    )
    assert {made.name for made in SENSORS.values()} == set(INSTRUMENTS)
    for keys, made in SENSORS.items():
        assert list(keys.model_fields) == fields_of(made)
    # what is told of a sensor, and what is wrong with it
    for apart in (ToldSensorsKeys, FaultySensorsKeys):
        assert set(aliases(apart).values()) == set(INSTRUMENTS)
    assert set(drive_file.PathKeys.model_fields) == {
        "path",
        *(name for way in DRIVES.values() for name in fields_of(way)),
    }
    assert set(get_args(drive_file.PathKeys.model_fields["path"].annotation)) == set(DRIVES)
    assert set(get_args(LogFormat)) == {*SYSTEM_OF, *OF_ANY_ROBOT}
    assert options.READINGS == READINGS


@pytest.mark.parametrize("keys", SENSORS)
def test_the_schema_s_defaults_are_the_instruments_(keys):
    """Each default written out, degrees and all, makes the instrument that leaving it out makes."""
    written = {field.alias or name: field.default for name, field in keys.model_fields.items()}
    kind = SENSORS[keys].name
    made = instrument_of(SensorKeys.model_validate({kind: written}))
    for field in dataclasses.fields(SENSORS[keys]):
        assert_close(getattr(made, field.name), getattr(SENSORS[keys](), field.name))


def assert_close(value, expected):
    if expected is None or isinstance(expected, str):
        assert value == expected
    else:
        np.testing.assert_allclose(value, expected, rtol=0, atol=1e-12)


def test_the_schema_tells_the_document_s_numbers_of_each_robot():
    told = {
        key: part["description"]
        for key, part in json_schema("world")["$defs"]["RobotKeys"]["properties"].items()
    }
    assert told["rate"].endswith(
        "Default: mower 100, pioneer 10, gnss 200, pylon 10, landmarks 100, ranges 10."
    )
    assert told["headingSigma"].endswith("Default: mower 0.50015.")
    assert told["yawSigma"].endswith("Default: pylon 1.38827.")
    assert told["skid"].endswith("Default: pioneer [[0.5, 0.5], [0, 0], [2.5, -2.5]].")
    assert Pioneer().skid == ((0.5, 0.5), (0.0, 0.0), (2.5, -2.5))


@pytest.mark.parametrize(
    "name", [one.name for one in walk_packages(all_keys.__path__, f"{all_keys.__name__}.")]
)
def test_the_examples_of_the_schema_are_right(name):
    models = [
        one
        for one in vars(import_module(name)).values()
        if isinstance(one, type) and issubclass(one, fields.Strict)
    ]
    for model in models:
        for name, part in json_schema_of(model)["properties"].items():
            for example in part.get("examples", ()):
                assert (model.__name__, name, mistakes_in(model, name, example)) == (
                    model.__name__,
                    name,
                    [],
                )


def json_schema_of(model):
    schema = whole(model).model_json_schema()
    return {"properties": {}, **schema, **schema.get("$defs", {}).get(model.__name__, {})}


def mistakes_in(model, name, example):
    try:
        model.model_validate({name: example})
    except ValueError as error:
        return [detail["msg"] for detail in error.errors() if detail["loc"][0] == name]
    return []


@pytest.mark.parametrize("name", INSTRUMENTS)
def test_a_bias_has_a_key_for_each_number_that_a_sensor_tells_in_their_order(world, name):
    """Beside the outliers and the delay of every sensor, which come first."""
    around = "landmarks: [{id: 1, x: 2, y: 3}]\nboundary: [[0, 0], [4, 0], [4, 4], [0, 4]]\n"
    system = "pylon" if name in ("pylon", "lidar") else "mower"
    (attribute,) = (one for one, key in aliases(FaultySensorsKeys).items() if key == name)
    keys = next(
        one
        for one in get_args(FaultySensorsKeys.model_fields[attribute].annotation)
        if one is not type(None)
    )
    biases = [key for key in aliases(keys).values() if key.lower().endswith("bias")]
    written = ", ".join(f"{key}: {n + 1}" for n, key in enumerate(biases))
    made = world(HEAD + around + f"system: {system}\nsensors: [{{{name}: {{}}}}]\n"
                 f"faults: {{sensors: {{{name}: {{{written}}}}}}}\n")  # fmt: skip
    quantities = made.true_targets()[0][1].sensor.outputs
    assert len(biases) == len(quantities)
    bias = made.drive_faults.sensors[name].bias
    for n, (one, quantity) in enumerate(zip(bias, quantities, strict=True)):
        assert one == (math.radians(n + 1) if quantity.unit == "rad" else n + 1)


def test_the_schema_says_which_keys_go_together():
    schema = json_schema("world")
    assert schema["required"] == ["name", "start"]
    classroom, *others = schema["allOf"]
    assert classroom["if"] == {"properties": {"system": {"const": "classroom"}}}
    assert classroom["then"]["required"] == ["noise"]
    assert (
        classroom["then"]["properties"]["robot"],
        classroom["then"]["properties"]["sensors"],
    ) == (False, False)
    assert [other["if"]["properties"]["system"]["const"] for other in others] == list(SYSTEMS)
    pylon = next(
        other for other in others if other["if"]["properties"]["system"]["const"] == "pylon"
    )
    assert pylon["then"]["properties"] == {
        "noise": False,
        "robot": {
            "propertyNames": {
                "enum": ["rate", "forwardSigma", "lateralSigma", "yawSigma", "estimate"]
            }
        },
        "faults": {"propertyNames": {"enum": ["forwardBias", "lateralBias", "yawBias", "sensors"]}},
        "belief": {
            "properties": {
                "noise": False,
                "robot": {
                    "propertyNames": {
                        "enum": ["forwardSigma", "lateralSigma", "yawSigma", "estimate"]
                    }
                },
            }
        },
        "sensors": {"items": {"properties": {"ultrasonic": False, "infrared": False}}},
    }
    of_mower = next(
        other["then"] for other in others if other["if"]["properties"]["system"]["const"] == "mower"
    )
    for robot in (
        of_mower["properties"]["robot"],
        of_mower["properties"]["belief"]["properties"]["robot"],
    ):
        assert robot["properties"]["odometry"]["enum"] == ["gyro", "midpoint"]
    ways = [{"required": ["commands"]}, {"required": ["drive"]}, {"required": ["recording"]}]
    assert json_schema("commands")["oneOf"] == ways


def test_drives(scene):
    assert scene("drive: {path: spiral}\n").drive == Spiral()
    assert scene("drive: {path: spiral, width: 20, clockwise: true}\n").drive == Spiral(
        width=20.0, clockwise=True
    )
    square = scene("drive: {path: square, side: 3, speed: 1, turnRate: 90, laps: 2}\n").drive
    assert square == Square(3.0, 1.0, math.pi / 2, 2)
    assert isinstance(square.laps, int)
    assert scene("drive: {path: circle, radius: 3, laps: 1.5}\n").drive == Circle(3.0, laps=1.5)
    loaded = scene("drive: [{v: 1, omega: -180, for: 2.5}, {for: 3}]\n")
    assert loaded.drive == Stretches((Stretch(1.0, -math.pi, 2.5), Stretch(0.0, 0.0, 3.0)))
    assert (loaded.commands, loaded.log, loaded.log_source, loaded.reading) == (
        (),
        None,
        None,
        "corrected",
    )


def test_a_reading_is_part_of_what_an_output_says(scene):
    assert {"log", "reading"}.isdisjoint(provenance(scene("drive: {path: spiral}\n")))
    assert provenance(scene("drive: {path: spiral}\n", reading="coded"))["reading"] == "coded"


ROOMS = {
    "no noise": (
        HEAD,
        [
            "1:1: noise: the key is missing; write noise: {executionDstSigmaRatio: 0.05, "
            "executionAngSigmaRatio: 0.05, odometryDstSigmaRatio: 0.02, odometryAngSigmaRatio: "
            "0.02, rangeSigmaRatio: 0.01}"
        ],
    ),
    "misspelt noise": (HEAD + "nois: {}\n", ["3:1: unknown key 'nois'; did you mean 'noise'?"]),
    "no system": (
        HEAD + "system: mowr\nrobot: {}\n",
        ["3:9: system: 'mowr' is not known here; did you mean 'mower'?"],
    ),
    "a number for a system": (
        HEAD + "system: 5\n",
        [
            "3:9: system: 5 is a number where a word belongs; write classroom, mower, pioneer, "
            "gnss, pylon, landmarks or ranges"
        ],
    ),
    "a robot in the classroom": (
        CLASSROOM + "robot: {rate: 5}\nsensors: []\n",
        [
            "4:8: robot: the classroom's robot is told by 'noise'; delete 'robot', or write e.g. "
            "system: mower",
            "5:10: sensors: the classroom's robot carries a laser; delete 'sensors', or write "
            "e.g. system: mower",
        ],
    ),
    "noise elsewhere": (
        CLASSROOM + "system: mower\nbelief: {noise: {rangeSigmaRatio: 1}}\nfaults: {}\n",
        [
            "3:8: noise: the noise ratios belong to the classroom's robot; 'robot' and 'sensors' "
            "hold that of the system 'mower'",
            "5:17: belief.noise: the noise ratios belong to the classroom's robot; 'robot' and "
            "'sensors' hold that of the system 'mower'",
        ],
    ),
    "another's keys": (
        MOWER + "robot: {halfTrack: 0.2, wdth: 3}\n",
        [
            "5:20: robot.halfTrack: the robot of the system 'mower' has no key 'halfTrack'; it "
            "has: rate, width, wheelSigma, positionSigma, headingSigma, gyroSigma, odometry, "
            "estimate",
            "5:25: robot: unknown key 'wdth'; did you mean 'width'?",
        ],
    ),
    "told and wrong in the classroom": (
        CLASSROOM + "belief: {robot: {width: 1}, sensors: {}}\nfaults: {rangeBias: 1, gyroBias: 1, "
        "gyroBais: 1}\n",
        [
            "4:17: belief.robot: what is believed of the classroom's robot is told by 'noise'; "
            "delete 'robot', or write e.g. noise: {rangeSigmaRatio: 0.02}",
            "4:38: belief.sensors: what is believed of the classroom's laser is told by 'noise'; "
            "delete 'sensors', or write e.g. noise: {rangeSigmaRatio: 0.02}",
            "5:34: faults.gyroBias: the classroom's robot has no fault 'gyroBias'; it may have: "
            "rangeBias, rangeScale, shortReturns, odometryDstScale, odometryAngScale",
            "5:37: faults: unknown key 'gyroBais'; did you mean 'gyroBias'?",
        ],
    ),
    "told and wrong elsewhere": (
        MOWER
        + "belief: {robot: {rate: 5, halfTrack: 1, odometry: arctan, headingSigma: -1}, sensors: "
        "{gnss: {}, markers: {range: 3}}}\n"
        "faults: {rangeBias: 1, yawBias: 2, leftScale: x, sensors: {infrared: {bias: 1}, markers: "
        "{azimuthBais: 1, outliers: 2, delay: -1}}}\n",
        [
            "5:18: belief.robot: unknown key 'rate'; known keys here: width, wheelSigma, "
            "positionSigma, headingSigma, gyroSigma, wheelRatio, wheelFloor, odometry, skid, "
            "skidSigma, halfTrack, speedDensity, turnDensity, startSpeedSigma, forwardSigma, lateralSigma, "
            "yawSigma, distanceDensity, headingDensity, estimate",
            "5:38: belief.robot.halfTrack: the robot of the system 'mower' has no key "
            "'halfTrack'; it has: width, wheelSigma, positionSigma, headingSigma, gyroSigma, "
            "odometry, estimate",
            "5:51: belief.robot.odometry: the robot of the system 'mower' has no odometry "
            "'arctan'; write gyro or midpoint",
            "5:73: belief.robot.headingSigma: -1 is negative; write a number of 0 or more",
            "5:94: belief.sensors.gnss: the world has no sensor 'gnss'; it has: markers",
            "5:108: belief.sensors.markers: unknown key 'range'; known keys here: mount, "
            "delay, height, azimuthSigma, elevationSigma",
            "6:21: faults.rangeBias: the robot of the system 'mower' has no fault 'rangeBias'; it "
            "may have: leftScale, rightScale, gyroBias, sensors",
            "6:33: faults.yawBias: the robot of the system 'mower' has no fault 'yawBias'; it may "
            "have: leftScale, rightScale, gyroBias, sensors",
            "6:47: faults.leftScale: 'x' is text where a number belongs; write e.g. 1.05",
            "6:70: faults.sensors.infrared: the world has no sensor 'infrared'; it has: markers",
            "6:91: faults.sensors.markers: unknown key 'azimuthBais'; did you mean 'azimuthBias'?",
            "6:117: faults.sensors.markers.outliers: 2 is too large; write a number from 0 to 1",
            "6:127: faults.sensors.markers.delay: -1 is negative; write a number of 0 or more",
        ],
    ),
    "told to be another": (
        HEAD + "system: pioneer\nbelief: {robot: {odometry: skidSteer, skid: [[1, 1], [0, 0], [2, "
        "2]]}}\n",
        [
            "4:28: belief.robot.odometry: a robot of the odometry 'arctan' cannot be read as one "
            "of 'skidSteer'; write robot: {odometry: skidSteer} as well, or skidSteer in neither",
            "4:45: belief.robot.skid: by its rows 1 and 3, other speeds of the two sides make the "
            "same motion; write e.g. [[0.5, 0.5], [0, 0], [2.5, -2.5]]",
        ],
    ),
    "numbers of a robot": (
        HEAD + "system: pioneer\nrobot: {odometry: skid, width: 0, rate: -1, wheelRatio: -2, skid: "
        "[[1, 1], [0, 0]]}\n",
        [
            "4:19: robot.odometry: 'skid' is not known here; did you mean 'skidSteer'?",
            "4:32: robot.width: 0 is too small; write more than 0",
            "4:41: robot.rate: -1 is negative; write more than 0",
            "4:57: robot.wheelRatio: -2 is negative; write a number of 0 or more",
            "4:67: robot.skid: 2 values stand where a list of three pairs belongs; write e.g. "
            "[[0.5, 0.5], [0, 0], [2.5, -2.5]]",
        ],
    ),
    "a matrix that tells nothing": (
        HEAD + "system: pioneer\nrobot: {skid: [[1, 1], [0, 0], [2, 2]]}\n",
        [
            "4:15: robot.skid: by its rows 1 and 3, other speeds of the two sides make the same "
            "motion; write e.g. [[0.5, 0.5], [0, 0], [2.5, -2.5]]"
        ],
    ),
    "items": (
        GNSS
        + "sensors:\n  - {gnss: {}, pylon: {}}\n  - {}\n  - gns: {}\n  - camera: {}\n  - gnss\n  "
        "- gnss:\n",
        [
            "5:5: sensors[0]: 'gnss' and 'pylon' stand in one item; begin each sensor with '- ' "
            "on a line of its own",
            "6:5: sensors[1]: the sensor is missing; write one of markers, rangeBearing, range, "
            "bearing, gnss, pylon, lidar, ultrasonic, infrared, compass, gyro",
            "7:5: sensors[2]: 'gns' is not a sensor; did you mean 'gnss'?",
            "8:5: sensors[3]: 'camera' is not a sensor; known sensors here: markers, "
            "rangeBearing, range, bearing, gnss, pylon, lidar, ultrasonic, infrared, compass, gyro",
            "9:5: sensors[4]: 'gnss' is text where a sensor belongs; write e.g. {markers: {rate: "
            "0.5, range: 10}}",
            "10:10: sensors[5].gnss: nothing stands where a mapping 'key: value' belongs; write "
            "e.g. {rate: 10, sigma: 0.15}",
        ],
    ),
    "numbers of a sensor": (
        HEAD + "system: mower\nsensors:\n  - markers: {views: [[30, -30], [0, 361], [0, 0], [-180, "
        "190], [1]], range: 0, azimuthSigma: -1, rate: 0}\n"
        "  - gnss: {sigma: .nan}\n  - infrared: {colour: pink, bearings: [], nearest: 0}\n  - "
        "bearing: {views: []}\n",
        [
            "5:23: sensors[0].markers.views[0]: 30 is not less than -30; write the bearing to its "
            "right first, e.g. [-30, 30]",
            "5:38: sensors[0].markers.views[1][1]: 361 is too large; write a number of at most 360",
            "5:44: sensors[0].markers.views[2]: 0 is not less than 0; write the bearing to its "
            "right first, e.g. [0, 60]",
            "5:52: sensors[0].markers.views[3]: 370 degrees are more than all round; write [-180, "
            "180]",
            "5:65: sensors[0].markers.views[4]: 1 value stands where a pair [from, to] belongs; "
            "write e.g. [-30, 30]",
            "5:78: sensors[0].markers.range: 0 is too small; write more than 0",
            "5:95: sensors[0].markers.azimuthSigma: -1 is negative; write a number of 0 or more",
            "5:105: sensors[0].markers.rate: 0 is too small; write more than 0",
            "6:19: sensors[1].gnss.sigma: .nan is not a finite number; write e.g. 0.1",
            "7:24: sensors[2].infrared.colour: 'pink' is not known here; write white, yellow, "
            "red, grey, blue, green or black",
            "7:40: sensors[2].infrared.bearings: an empty list stands here; write e.g. [-90, 0, "
            "90]",
            "7:53: sensors[2].infrared.nearest: 0 is too small; write more than 0",
            "8:22: sensors[3].bearing.views: an empty list stands here; write e.g. [[-35, 35]]",
        ],
    ),
    "sensors that cannot be carried": (
        GNSS + "sensors:\n  - pylon: {}\n  - ultrasonic: {}\n  - infrared: {}\n  - lidar: {}\n",
        [
            "5:12: sensors[0].pylon: the robot of the system 'gnss' cannot carry the sensor "
            "'pylon'; write lidar, which no measured yaw has to turn",
            "6:17: sensors[1].ultrasonic: the robot of the system 'gnss' cannot carry the sensor "
            "'ultrasonic'; the robot of mower, pioneer, landmarks or ranges can",
            "7:15: sensors[2].infrared: the robot of the system 'gnss' cannot carry the sensor "
            "'infrared'; the robot of mower, pioneer, landmarks or ranges can",
        ],
    ),
    "two of a kind": (
        HEAD + "system: mower\nsensors:\n  - gnss: {}\n  - markers: {}\n  - gnss: {sigma: 1}\n  - "
        "markers: {}\n  - ultrasonic: {}\n"
        "  - {ultrasonic: {rate: -1}}\n",
        [
            "7:11: sensors[2].gnss: the sensor 'gnss' on line 5 goes by the same name; give "
            "one a 'name', or keep one of them",
            "8:14: sensors[3].markers: the sensor 'markers' on line 6 goes by the same name; "
            "give one a 'name', or keep one of them, with the 'views' of both",
            "10:18: sensors[5].ultrasonic: the sensor 'ultrasonic' on line 9 goes by the same "
            "name; give one a 'name', or keep one of them, with the 'bearings' of both",
            "10:25: sensors[5].ultrasonic.rate: -1 is negative; write more than 0",
        ],
    ),
    "nothing between": (
        HEAD
        + "system: pioneer\nsensors:\n  - ultrasonic: {nearest: 2}\n  - infrared: {range: 0.05}\n",
        [
            "5:17: sensors[0].ultrasonic: nothing lies between its nearest 2 m and its range of 2 "
            "m; write a range that is more than the nearest",
            "6:15: sensors[1].infrared: nothing lies between its nearest 0.1 m and its range of "
            "0.05 m; write a range that is more than the nearest",
        ],
    ),
    "no lists": (
        MOWER + "sensors: 5\nrobot: []\nexpectedPath: [[0, 0]]\n",
        [
            "5:10: sensors: 5 is a number where a list belongs; write e.g. [{markers: {rate: 0.5, "
            "range: 10}}]",
            "6:8: robot: a list stands where a mapping 'key: value' belongs; write e.g. {rate: "
            "100, width: 1.41}",
            "7:15: expectedPath: 1 point makes no way; write at least two, e.g. [[0, 0], [10, 0], "
            "[10, -10], [0, -10]]",
        ],
    ),
}


def told_of(folder, text, **options):
    """What is told of a file, without the folder it lies in."""
    path = folder / "f.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as told:
        (read_scene(path, **options) if options else check(path)).get()
    return [line.replace(f"{folder}/", "") for line in str(told.value).splitlines()]


@pytest.mark.parametrize("case", ROOMS)
def test_mistakes_of_a_world(tmp_path, case):
    text, lines = ROOMS[case]
    assert told_of(tmp_path, text) == [f"f.yaml:{line}" for line in lines]


LENGTH = "drive a shorter while, or lower the robot's rate"
SCENES = {
    "commands for a mower": (
        "mower",
        "commands: []\n",
        ["2:11: commands: the robot of the system 'mower' obeys no commands; write 'drive' or "
         "'recording', or name a world of the classroom"],
    ),
    "a misspelt way": ("mower", "drivs: {path: square}\nfilter: lkf\n", ["2:1: unknown key 'drivs'; did you mean 'drive'?", "3:9: filter: 'lkf' is not known here; did you mean 'kf'?"]),
    "no way": ("mower", "seed: 3\n", ["1:1: the file says nothing to do; write one of commands, "
                                      "drive, recording"]),
    "a word for a way": ("mower", "drive: square\n", ["2:8: drive: 'square' is text where a drive "
                                                      "belongs; write e.g. {path: spiral, width: "
                                                      "50, length: 75, spacing: 4, duration: 549}"]),
    "two ways": (
        "mower",
        "drive: {path: spiral}\nrecording: {format: mower}\n",
        ["3:12: recording: 'drive' on line 2 says already what happens; keep one of them"],
    ),
    "a drive in the classroom": (
        "classroom",
        "drive: {path: spiral}\n",
        ["2:8: drive: the classroom's robot is not driven, it obeys commands; write 'commands', "
         "or name a world of another system"],
    ),
    "a recording in the classroom": (
        "classroom",
        "recording: {format: mrclam}\n",
        ["2:21: recording.format: a 'mrclam' log is of the system 'landmarks', the world of the "
         "system 'classroom'; name a world of the system 'landmarks'"],
    ),
    "a plan that no recording tells": (
        "gnss",
        "recording: {format: gnss}\nfilter: kf-nominal\n",
        ["3:9: filter: a recording does not tell the way that was planned; write kf or ekf"],
    ),
    "a recording of another": (
        "mower",
        "recording: {format: pylon}\n",
        ["2:21: recording.format: a 'pylon' log is of the system 'pylon', the world of the system "
         "'mower'; name a world of the system 'pylon'"],
    ),
    "keys of a recording": (
        "mower",
        "recording: {format: mowr, path: 5, file: x}\n",
        [
            "2:21: recording.format: 'mowr' is not known here; did you mean 'mower'?",
            "2:33: recording.path: 5 is a number where text belongs; write it in quotes: '5'",
            "2:36: recording: unknown key 'file'; known keys here: format, path, robot, timeUnit, "
            "angleUnit, targets, turnTruth, sameTime, columns, units, motion, readings, landmarks, "
            "truth, topics, origin",
        ],
    ),
    "no format": (
        "mower",
        "recording: {path: x.csv}\n",
        ["2:12: recording.format: the key is missing; write format: pylon"],
    ),
    "a path for a recording": (
        "mower",
        "recording: log.txt\n",
        ["2:12: recording: 'log.txt' is text where a mapping 'key: value' belongs; write e.g. "
         "{format: pylon, path: ../logs/square.csv}"],
    ),
    "no drive": (
        "mower",
        "drive: x\n",
        ["2:8: drive: 'x' is text where a drive belongs; write e.g. {path: spiral, width: 50, "
         "length: 75, spacing: 4, duration: 549}"],
    ),
    "an empty drive": (
        "mower",
        "drive: []\n",
        ["2:8: drive: an empty list stands here; write e.g. {path: spiral, width: 50, length: 75, "
         "spacing: 4, duration: 549}"],
    ),
    "no path": ("mower", "drive: {}\n",
    ["2:8: drive.path: the key is missing; write path: spiral"]),
    "another path": (
        "mower",
        "drive: {path: zigzag, sied: 5, colour: 3}\n",
        [
            "2:15: drive.path: 'zigzag' is not known here; write spiral, square or circle",
            "2:23: drive: unknown key 'sied'; did you mean 'side'?",
            "2:32: drive: unknown key 'colour'; known keys here: path, width, length, spacing, "
            "duration, side, radius, speed, turnRate, laps, clockwise",
        ],
    ),
    "a square": (
        "mower",
        "drive: {path: square, width: 5, laps: 1.5, speed: 0, clockwise: 1}\n",
        [
            "2:30: drive.width: a square has no key 'width'; it has: path, side, speed, turnRate, "
            "laps, clockwise",
            "2:39: drive.laps: 1.5 is no whole number of squares; write 1",
            "2:51: drive.speed: 0 is too small; write more than 0",
            "2:65: drive.clockwise: 1 is a number where true or false belongs; write e.g. true",
        ],
    ),
    "too many rounds": (
        "mower",
        "drive: {path: spiral, spacing: 0.001}\n",
        ["2:32: drive.spacing: so near to each other, there are 20000 rounds, more than 200; "
         "write at least 0.1"],
    ),
    "too long": (
        "mower",
        "drive: {path: spiral, duration: 10001}\n",
        [f"2:8: drive: the drive takes 1 000 100 steps at the robot's 100 Hz, more than 1 000 "
         f"000; {LENGTH}"],
    ),
    "far too long": (
        "mower",
        "drive: {path: circle, radius: 1000000, speed: 1.0e-6}\n",
        [f"2:8: drive: the drive takes about 6e+14 steps at the robot's 100 Hz, more than 1 000 "
         f"000; {LENGTH}"],
    ),
    "many tiny squares": (
        "mower",
        "drive: {path: square, side: 0.000001, turnRate: 100000, laps: 1000000}\n",
        [f"2:8: drive: the drive takes 8 000 000 steps at the robot's 100 Hz, more than 1 000 "
         f"000; {LENGTH}"],
    ),
    "too short": (
        "mower",
        "drive: [{v: 1, for: 0.002}]\n",
        ["2:8: drive: the drive ends before the robot's first step, at 100 Hz; drive at least "
         "0.01 s"],
    ),
    "speeds": (
        "mower",
        "drive: [{v: 1, omega: 5, for: 0}, {v: x, for: 5}, 5, {v: 1}, {v: 1, fro: 2}]\n",
        [
            "2:31: drive[0].for: 0 is too small; write more than 0",
            "2:39: drive[1].v: 'x' is text where a number belongs; write e.g. 0.5",
            "2:51: drive[2]: 5 is a number where a stretch belongs; write e.g. {v: 0.5, omega: "
            "45, for: 2}",
            "2:54: drive[3].for: the key is missing; write for: 2",
            "2:69: drive[4]: unknown key 'fro'; did you mean 'for'?",
        ],
    ),
}  # fmt: skip


@pytest.fixture
def worlds(tmp_path):
    for name, text in {"mower": MOWER, "classroom": CLASSROOM, "gnss": GNSS}.items():
        (tmp_path / f"{name}.yaml").write_text(text)
    return tmp_path


@pytest.mark.parametrize("case", SCENES)
def test_mistakes_of_a_commands_file(worlds, case):
    world, text, lines = SCENES[case]
    assert told_of(worlds, f"world: {world}.yaml\n{text}") == [f"f.yaml:{line}" for line in lines]


def test_a_scene_in_which_nothing_happens(worlds):
    (worlds / "f.yaml").write_text("world: mower.yaml\nseed: 1\n")
    with pytest.raises(InputError) as told:
        load_scene(worlds / "f.yaml")
    assert (
        str(told.value)
        == f"{worlds}/f.yaml:1:1: the file says nothing to do; write one of commands, drive, "
        f"recording"
    )
    (worlds / "f.yaml").write_text("world: mower.yaml\ndriev: {}\n")
    with pytest.raises(InputError) as told:
        load_scene(worlds / "f.yaml")
    assert str(told.value) == f"{worlds}/f.yaml:2:1: unknown key 'driev'; did you mean 'drive'?"


def test_a_world_given_must_fit_too(worlds):
    text = "world: mower.yaml\ndrive: {path: spiral}\n"
    wrong = "the classroom's robot is not driven, it obeys commands"
    right = "write 'commands', or name a world of another system"
    assert told_of(worlds, text, world=worlds / "classroom.yaml") == [
        f"f.yaml:2:8: drive: {wrong}; {right}"
    ]


def test_a_log_for_what_was_not_recorded(worlds):
    told = "--log has nothing to replace"
    lines = told_of(worlds, "world: mower.yaml\ndrive: {path: spiral}\n", log="x")
    assert lines == [f"f.yaml:2:8: drive: the file has 'drive', not a recording; {told}"]


def test_a_recording_without_a_path_is_right_and_wants_one(worlds):
    text = "world: gnss.yaml\nrecording: {format: gnss}\n"
    (worlds / "f.yaml").write_text(text)
    assert check(worlds / "f.yaml").mistakes == []
    lines = told_of(worlds, text, reading="printed")
    assert lines == ["f.yaml:2:12: recording: the recording names no path; give one with --log"]


def test_a_log_that_is_not_there(worlds):
    text = "world: gnss.yaml\nrecording: {format: gnss, path: logs}\n"
    (line,) = told_of(worlds, text)
    assert line.startswith("f.yaml:2:33: recording.path: logs: no such f")
    with pytest.raises(UsageError) as told:
        load_scene(worlds / "f.yaml", log=worlds / "other")
    assert not isinstance(told.value, InputError)
    assert str(told.value).startswith(f"{worlds}/other: no such f")


@pytest.mark.skipif(not LOGS.exists(), reason="the recorded logs do not lie beside the project")
def test_a_log_is_read_with_its_landmarks(worlds, tmp_path):
    folder = (LOGS / "mrclam6_robot1").resolve()
    (worlds / "hall.yaml").write_text(HEAD + "system: landmarks\n")
    (worlds / "f.yaml").write_text(
        f"world: hall.yaml\nrecording: {{format: mrclam, path: {folder}}}\n"
    )
    found = check(worlds / "f.yaml")
    assert not [warning for warning in found.warnings if "landmarks" in warning]
    scene = found.get()
    assert len(scene.world.landmarks) == 15
    assert len(scene.log.entries) > 25_000
    assert provenance(scene)["log"] == str(folder)
    (worlds / "f.yaml").write_text("world: hall.yaml\nrecording: {format: mrclam, path: nowhere}\n")
    again = load_scene(worlds / "f.yaml", log=folder, reading="printed")
    assert (again.reading, len(again.log.entries)) == ("printed", len(scene.log.entries))


def test_warnings(worlds):
    def told(world, text="drive: {path: spiral}\n"):
        (worlds / "world.yaml").write_text(world)
        (worlds / "f.yaml").write_text("world: world.yaml\n" + text)
        return [warning.replace(f"{worlds}/", "") for warning in check(worlds / "f.yaml").warnings]

    of_markers = (
        "the sensor 'markers' sees landmarks, and the world has none; list them under 'landmarks'"
    )
    assert told(MOWER) == []
    assert told(HEAD + "system: mower\n") == [f"world.yaml:3:9: system: {of_markers}"]
    assert told(HEAD + "system: mower\n", "recording: {format: mower}\n") == []
    of_rate = "is to be read at 200 Hz, the robot moves at 100 Hz; it is read once at each motion"
    assert told(HEAD + "system: mower\nsensors:\n  - gnss: {rate: 200}\n  - markers: {}\n") == [
        f"world.yaml:5:11: sensors[0].gnss: the sensor 'gnss' {of_rate}",
        f"world.yaml:6:14: sensors[1].markers: {of_markers}",
    ]
    of_walls = "sees walls, and the world has none; write a 'boundary', 'obstacles' or 'walls'"
    assert told(HEAD + "system: pioneer\n") == [
        f"world.yaml:3:9: system: the sensor '{name}' {of_walls}"
        for name in ("ultrasonic", "infrared")
    ]
    lines = told(MOWER, "drive: [{v: 1, omega: 1.5708, for: 1}, {v: 1, omega: -400, for: 1}]\n")
    radians = "1.5708 looks like radians; turn rates are in degrees per second: write 90"
    assert lines == [f"f.yaml:2:23: drive[0].omega: {radians}"]
    narrow = (
        MOWER
        + "sensors:\n  - markers: {views: [[-0.5, 0.5], [3, 6.2]]}\n  - bearing: {views: [[-7, "
        "7]]}\n"
    )
    of_views = (
        "the sensor 'markers' sees a few degrees only; 'views' are in degrees: [-30, 30] "
        "looks ahead"
    )
    assert told(narrow) == [f"world.yaml:6:14: sensors[0].markers: {of_views}"]
    beams = (
        HEAD
        + "system: pioneer\nboundary: [[0, 0], [4, 0], [4, 4]]\nsensors: [{infrared: {bearings: "
        "[0, 0.785, 45]}}]\n"
    )
    of_beams = "0.785 looks like radians; angles are in degrees: write 45"
    assert (
        told(beams, "drive: {path: square}\n")[-1]
        == f"world.yaml:5:37: sensors[0].infrared.bearings[1]: {of_beams}"
    )


@pytest.mark.parametrize("name", ["mower", "pioneer", "gnss", "pylon", "landmarks", "ranges"])
def test_the_packaged_systems(name):
    scene = load_scene(name)
    assert scene.world.system == name
    told, document = vars(scene.world.told_robot), vars(SYSTEMS[name].robot)
    for key, number in document.items():
        assert told[key] == (
            pytest.approx(number, rel=1e-15) if isinstance(number, float) else number
        ), key
    assert scene.world.instruments == scene.world.told_instruments == SYSTEMS[name].instruments
    assert scene.drive is not None


def test_the_packaged_logs():
    for name in ("mower", "pioneer", "gnss", "pylon", "mrclam", "ranges"):
        found = check(packaged("commands")[f"{name}_log"])
        assert (found.mistakes, found.warnings) == ([], [])
        assert found.get().world.system == SYSTEM_OF[name]
        assert found.get().gate == (0.999 if name in ("mrclam", "ranges") else None)


def test_the_packaged_mower_is_the_document_s():
    scene = load_scene("mower")
    # the gyro is better than Q
    assert scene.world.robot.heading_sigma < 0.1 * scene.world.told_robot.heading_sigma
    marks = np.array([[mark.x, mark.y] for mark in scene.world.landmarks])
    apart = np.linalg.norm(np.diff(marks, axis=0), axis=1)
    assert len(marks) == 28
    assert np.median(apart) == pytest.approx(6, abs=0.5)
    course = scene.drive.course(1 / scene.world.robot.rate)
    assert len(course.speed) == 54_900
    poses = course.poses(scene.world.start, 0.01)
    low, high = poses[:, :2].min(axis=0), poses[:, :2].max(axis=0)
    np.testing.assert_array_less([-37.6, -25.1], low)
    np.testing.assert_array_less(high, [37.6, 25.1])
