"""Real logs: the numbers that small independent scripts found."""

from dataclasses import replace

import numpy as np
import pytest
from log_worlds import PYLON, errors, read, rmse, shared, steps_of, world

from ekfsim.localization import play
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene
from ekfsim.systems.instruments import Bearings, RangeBearings, Ranges

STATES = {  # row: x, y, ẋ, ẏ, θ, variance of x, of y
    0: (0.157577, -0.145731, 0.015602, -0.014429, 0.000000, 5.6247e-05, 5.6247e-05),
    1: (0.148061, -0.132813, -0.094538, 0.128368, 0.000000, 5.5940e-05, 5.5938e-05),
    2: (0.151754, -0.138834, 0.005190, -0.007394, 0.000000, 5.0147e-05, 4.9290e-05),
    10: (0.167708, -0.119587, -0.010448, 0.027601, 0.003272, 4.8715e-05, 4.6887e-05),
    100: (4.751742, 0.058660, 0.759268, -0.157790, -0.015272, 4.8714e-05, 4.6891e-05),
    350: (10.487867, -8.957226, 0.644122, 0.665278, -1.684243, 4.6898e-05, 4.8706e-05),
    706: (0.185941, -0.240789, -0.048696, 0.023683, -0.007636, 4.8715e-05, 4.6888e-05),
}


def off_the_square(places):
    """Eq. 11: the distance from the nearest side's line, beyond a corner from the corner. places :
    (n, 2)"""
    x, y = places.T
    line = np.min([abs(x - 10), abs(x), abs(y + 10), abs(y)], axis=0)
    dx, dy = np.maximum(np.maximum(-x, x - 10), 0), np.maximum(np.maximum(y, -10 - y), 0)
    return np.where((dx > 0) & (dy > 0), np.hypot(dx, dy), line)


def path_rmse(places):
    return float(np.sqrt(np.mean(off_the_square(places) ** 2)))


def corrected_places(steps):
    """The last estimate of every row : (707, 2)"""
    last = {step.entry.t: step.posterior.mean for step in steps if step.entry.index}
    return np.array(list(last.values()))[:, [1, 3]]


@pytest.fixture(scope="module")
def coded():
    return steps_of("pylon", shared("pylon"), reading="coded")


def test_the_authors_filter_of_the_pylon_to_the_digit(coded):
    steps, _, warnings = coded
    rows = [step for step in steps if step.correction is not None]
    assert len(rows) == 707
    for row, expected in STATES.items():
        x, P = rows[row].posterior
        np.testing.assert_allclose(x[[1, 3, 0, 2, 5]], expected[:5], rtol=0, atol=1e-6)
        np.testing.assert_allclose([P[1, 1], P[3, 3]], expected[5:], rtol=0, atol=1e-9)
    off = off_the_square(corrected_places(steps))
    assert np.sqrt(np.mean(off**2)) == pytest.approx(0.230198957, abs=1e-8)
    assert off.mean() == pytest.approx(0.191488, abs=1e-6)
    assert off.max() == pytest.approx(1.0976, abs=1e-4)
    assert off.argmax() == 649
    assert [
        told for told in warnings if "taken is (0, 0, 0°), the start of test" in told
    ] == warnings


def test_the_pylon_read_from_its_folder_or_its_file_is_the_same():
    folder = shared("pylon")
    (file,) = folder.glob("*.csv")
    assert (
        len(read("pylon", file).log.entries)
        == len(read("pylon", folder).log.entries)
        == 1 + 2 * 707
    )


def test_every_second_correction_of_the_pylon(coded):
    _, scene, _ = coded
    for left_out in (0, 1):
        readings = [entry for entry in scene.log.entries if isinstance(entry.given, Reading)][
            left_out::2
        ]
        skipped = {entry.index for entry in readings}
        entries = tuple(entry for entry in scene.log.entries if entry.index not in skipped)
        found = path_rmse(
            corrected_places(play(replace(scene, log=replace(scene.log, entries=entries))))
        )
        if found == pytest.approx(0.233241404, abs=1e-8):
            return
    pytest.fail(f"neither half gives 0.233241404, but {found}")


def test_the_printed_minus_and_the_stamps_of_the_pylon(coded):
    steps, _, _ = steps_of("pylon", shared("pylon"), reading="printed")
    assert path_rmse(corrected_places(steps)) == pytest.approx(0.231986, abs=1e-6)
    _, scene, _ = coded
    entries, before = [], 0.0
    for entry in scene.log.entries:
        given = entry.given
        if isinstance(given, Control):
            u = np.array([*given.u[:3], entry.t - before])
            entry, before = replace(entry, given=Control(given.motion, u)), entry.t
        entries.append(entry)
    stamped = replace(scene, log=replace(scene.log, entries=tuple(entries)))
    assert path_rmse(corrected_places(play(stamped))) == pytest.approx(0.230220, abs=1e-6)


def test_the_pylons_times_headings_and_gps(coded):
    steps, scene, _ = coded
    controls = [entry for entry in scene.log.entries if isinstance(entry.given, Control)]
    assert controls[-1].t - controls[0].t == pytest.approx(73.3, abs=2e-3)
    assert {float(entry.given.u[3]) for entry in controls} == {0.1}
    assert [float(controls[row].given.u[2]) for row in (387, 465)] == [np.pi, np.pi]
    assert path_rmse(np.array([entry.fix for entry in controls])) == pytest.approx(
        0.454782, abs=1e-6
    )
    measured = read("pylon", shared("pylon")).log.entries
    dt = np.array([entry.given.u[3] for entry in measured if isinstance(entry.given, Control)])
    assert np.median(dt) == pytest.approx(0.0993, abs=1e-4)
    assert np.sum(dt > 0.15) == 20
    np.testing.assert_array_equal(steps[0].posterior.mean, np.zeros(7))
    np.testing.assert_array_equal(steps[0].posterior.covariance, np.eye(7))


def test_wheel_speeds_and_fixes_of_a_lawn_mower():
    steps, scene, warnings = steps_of("gnss", shared("mower_gnss"))
    assert warnings == []
    e = errors(steps, scene.world.layout)
    assert len(e) == 5201
    assert rmse(steps, scene) == pytest.approx(0.0846, abs=1e-3)
    np.testing.assert_allclose(
        np.sqrt(np.mean(e**2, axis=0)), [0.0553, 0.0640, 0.0969], rtol=0, atol=3e-4
    )
    at = {step.entry.t: step.posterior.mean[[2, 3, 1]] for step in steps}
    for t, pose in (
        (10, (9.0741, 0.0781, -0.0113)),
        (20, (25.0968, 0.0694, 0.0924)),
        (25, (28.5255, -5.0649, -2.1098)),
    ):
        np.testing.assert_allclose(at[t], pose, rtol=0, atol=1e-3)


def test_the_wheels_alone_of_a_lawn_mower():
    log = read("gnss", shared("mower_gnss")).log
    entries = tuple(entry for entry in log.entries if not isinstance(entry.given, Reading))
    scene = Scene(world("gnss"), log=replace(log, entries=entries))
    e = errors(play(scene), scene.world.layout)
    x, y, phi = np.sqrt(np.mean(e**2, axis=0))
    assert (x, y, phi) == pytest.approx((0.8394, 1.8264, 0.4006), abs=5e-5)
    assert np.hypot(e[:, 0], e[:, 1]).max() == pytest.approx(5.020, abs=5e-4)


@pytest.mark.parametrize(
    ("filter", "instrument", "expected"),
    [
        ("ekf", RangeBearings(), 0.202),
        ("ekf", Bearings(), 0.249),
        ("ekf", Ranges(sigma=0.3, scale=1.0, bias=0.0), 0.700),
        ("ukf", RangeBearings(), 0.157),
    ],
    ids=["ekf", "ekf bearing", "ekf range", "ukf"],
)
def test_landmarks_of_mrclam(filter, instrument, expected):
    place = world("mrclam", instruments=(instrument,))
    steps, scene, warnings = steps_of(
        "mrclam", shared("mrclam6_robot1"), place, filter=filter, gate=0.999
    )
    assert len(errors(steps, scene.world.layout)) == 25006
    assert rmse(steps, scene) == pytest.approx(expected, abs=1e-3)
    assert sum(step.correction is not None for step in steps) == 613
    assert any(
        "this measurement is of another robot, and so are 175 more: left out" in told
        for told in warnings
    )
    assert [mark.id for mark in scene.world.landmarks] == list(range(6, 21))


def test_ranges_of_plaza():
    steps, scene, warnings = steps_of("ranges", shared("plaza2_mower_ranges"), gate=0.999)
    assert len(errors(steps[1:], scene.world.layout)) == 4090
    assert rmse(steps, scene) <= 0.45
    assert np.degrees(np.sqrt(np.mean(errors(steps, scene.world.layout)[:, 2] ** 2))) < 2.8
    assert sum(step.correction is not None for step in steps) == 1816
    assert [told for told in warnings if "half a turn is added" in told] == warnings
    assert scene.log.entries[0].t == 3152.0


def test_the_pylon_wants_one_landmark():
    from ekfsim.errors import UsageError

    with pytest.raises(UsageError, match="one thing that the sensor pylon or lidar sees, not 2"):
        read("pylon", shared("pylon"), world("pylon", (*PYLON, PYLON[0]._replace(id=2))))
