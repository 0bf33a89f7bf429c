"""Compass and gyroscope of document 001: what they tell, and what a filter is told of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from documents import equation
from systems_scenes import yaws

from ekfsim.figures.crowd import crowd_of
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.records import Reading
from ekfsim.systems.faults import DriveFaults, SensorFaults
from ekfsim.systems.instruments import Compass, Gyro


def test_eq_36_drives_by_the_yaw_less_the_orientation_of_the_body():
    """x gains t v cos(ω − β): for a yaw ω that is read, the heading of the models is θ = ω − β."""
    assert equation("001", 36) == r"x_k=t\cdotv_k\cos(\omega_k-\beta_k)+x_{k-1}"
    x, β = np.array([1.0, 2.0, 3.0]), 0.7
    ω = Yaw(β, 0.1).h(x)[0]
    assert math.cos(ω - β) == pytest.approx(math.cos(x[2]))
    assert math.sin(ω - β) == pytest.approx(math.sin(x[2]))
    assert -math.pi < ω <= math.pi


def read(scene):
    """(name, z, true heading) of every reading."""
    found = [
        (s.entry.given.name, s.entry.given.z[0], s.entry.truth[2])
        for s in play(scene)
        if s.correction
    ]
    return [
        tuple(map(np.array, zip(*((z, θ) for n, z, θ in found if n == name), strict=True)))
        for name in ("compass", "gyro")
    ]


def test_a_compass_tells_the_heading_and_a_gyro_what_has_been_turned_since_the_mark():
    made = yaws()
    world = replace(
        made.world,
        start=np.array([0.0, 0.0, 1.0]),
        instruments=(Compass(5.0, 0.02, 0.3), Gyro(5.0, 0.01)),
    )
    made = replace(made, world=replace(world, told=replace(world.told, start=world.start)))
    (absolute, θ), (relative, θ_too) = read(made)
    assert len(absolute) == len(relative) > 30
    for z, heading, β, sigma in ((absolute, θ, 0.3, 0.02), (relative, θ_too, -1.0, 0.01)):
        error = np.angle(np.exp(1j * (z - heading - β)))
        assert abs(error.mean()) < 4 * sigma / math.sqrt(len(error))
        assert error.std() == pytest.approx(sigma, rel=0.5)
    assert abs(relative[0]) < 0.05  # it stood along the mark just now


def test_a_drift_of_the_gyro_is_a_fault_that_no_filter_is_told():
    made = yaws()
    faulty = replace(
        made,
        world=replace(
            made.world, drive_faults=DriveFaults(sensors={"gyro": SensorFaults(bias=(0.2,))})
        ),
    )
    (_, (z, _)), (_, (biased, _)) = read(made), read(faulty)
    np.testing.assert_allclose(np.angle(np.exp(1j * (biased - z))), 0.2, atol=1e-9)


def test_on_the_pioneer_s_square_a_gyro_keeps_the_heading_that_the_wheels_lose():
    """20 runs without a wall to see: the compass leaves less of the wheels' error, the gyro
    little."""
    scene = load_scene("pioneer")

    def heading(*instruments):
        made = replace(
            scene,
            world=replace(scene.world, instruments=instruments, told=replace(scene.world.told)),
        )
        crowd = crowd_of(made, 20)
        return float(np.sqrt(np.mean(crowd.heading**2))), float(
            np.sqrt(np.mean(crowd.reckoned[..., 2] ** 2))
        )

    (compass, wheels), (gyro, _) = heading(Compass()), heading(Gyro())
    assert gyro < 0.5 * compass < 0.5 * wheels
    assert wheels > math.radians(4)


def test_a_world_file_may_carry_both_and_a_filter_may_be_told_otherwise(tmp_path):
    (tmp_path / "w.yaml").write_text(
        "name: w\nsystem: pioneer\nstart: {x: 0, y: 0, theta: 90}\n"
        "sensors: [compass: {rate: 1, sigma: 5, orientation: 20}, gyro: {sigma: 2}]\n"
        "belief: {sensors: {compass: {sigma: 20, orientation: 0}, gyro: {sigma: 1}}}\n"
        "faults: {sensors: {gyro: {bias: 3, outliers: 0.1}}}\n"
    )
    (tmp_path / "c.yaml").write_text("world: w.yaml\ndrive: {path: square}\n")
    world = load_scene(tmp_path / "c.yaml").world
    degree = math.radians(1)
    assert world.instruments == (
        Compass(1.0, 5 * degree, pytest.approx(20 * degree)),
        Gyro(10.0, 2 * degree),
    )
    (_, compass), (_, gyro) = world.targets("corrected")
    assert (compass.name, compass.sensor) == ("compass", Yaw(0.0, pytest.approx(20 * degree)))
    assert (gyro.name, gyro.sensor) == (
        "gyro",
        Yaw(pytest.approx(-90 * degree), pytest.approx(degree)),
    )
    assert world.drive_faults.sensors["gyro"].bias == (pytest.approx(3 * degree),)
    steps = [
        step
        for step in play(load_scene(tmp_path / "c.yaml"))
        if isinstance(step.entry.given, Reading)
    ]
    assert {step.entry.given.name for step in steps} == {"compass", "gyro"}
