"""The same run under another reading of its document."""

from dataclasses import replace

from ekfsim.filters.belief import Gaussian
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.scene import Scene
from ekfsim.systems.document import DocumentReading


def retold(scene: Scene, reading: DocumentReading) -> Scene:
    """What happened stays;
    the motion, the sensors and the first covariance that the filter is told are the reading's.

    A simulation needs no more than the word: its truth and its noise are alike in every reading.
    """
    if scene.log is None or reading == scene.reading:
        return replace(scene, reading=reading)
    world, robot = scene.world, scene.world.believed_robot
    motion = robot.motion(reading)
    sensors = {target.name: target.sensor for _, target in world.targets(reading)}

    def told(entry: Entry) -> Entry:
        match entry.given:
            case Control(_, u):
                return replace(entry, given=Control(motion, u))
            case Reading(_, z, name):
                return replace(entry, given=Reading(sensors[name], z, name))
        return entry

    first = Gaussian(scene.log.first.mean, world.first_covariance(reading))
    return replace(scene, reading=reading, log=Log(tuple(map(told, scene.log.entries)), first))
