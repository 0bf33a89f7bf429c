"""Small scenes of driven robots, each with one thing that is wrong."""

from dataclasses import replace

import numpy as np

from ekfsim.systems.faults import DriveFaults, SensorFaults


def faulty(scene, **faults):
    return replace(scene, world=replace(scene.world, drive_faults=DriveFaults(**faults)))


def of_sensor(scene, **faults):
    called = scene.world.instruments[0].called
    return faulty(scene, sensors={called: SensorFaults(**faults)})


def told_sensor(scene, **numbers):
    (one,) = scene.world.instruments
    told = replace(scene.world.told, instruments=(replace(one, **numbers),))
    return replace(scene, world=replace(scene.world, told=told))


def told_robot(scene, **numbers):
    told = replace(scene.world.told, robot=replace(scene.world.robot, **numbers))
    return replace(scene, world=replace(scene.world, told=told))


def told_start(scene, *off):
    told = replace(scene.world.told, start=scene.world.start + np.array(off))
    return replace(scene, world=replace(scene.world, told=told))


def slower(scene, rate):
    """With so many motion inputs a second: cheaper runs."""
    robot = replace(scene.world.robot, rate=rate)
    return replace(scene, world=replace(scene.world, robot=robot))
