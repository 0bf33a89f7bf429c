"""A log of anybody's make: a folder of tables whose first lines name their columns."""

from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import folder_of
from ekfsim.files.logs.named.files import HOLDS, motion_file, readings_files
from ekfsim.files.logs.named.motion import WANTED as MOTION
from ekfsim.files.logs.named.motion import motions_of
from ekfsim.files.logs.named.places import landmarks_in, truth_in
from ekfsim.files.logs.named.readings import WANTED as READINGS
from ekfsim.files.logs.named.readings import fittings_of, samples_of
from ekfsim.files.logs.named.tables import named
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.timeline import Timeline


def read_named(asked: Asked) -> Recorded:
    """What the robot did, what its sensors told, what stands where, and where the robot truly was.
    Errors are counted at the rows of the motion.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, _, warnings = asked
    folder = folder_of(path, HOLDS)
    motion = named(motion_file(folder), MOTION)
    landmarks = landmarks_in(folder, warnings)
    truth = truth_in(folder, warnings)
    motions = motions_of(motion, asked, truth)
    fittings = fittings_of(world, reading, world.landmarks if landmarks is None else landmarks)
    samples = [
        sample
        for file in readings_files(folder)
        for sample in samples_of(named(file, READINGS), fittings, warnings)
    ]
    start = float(motions.begin[0])
    timeline = Timeline(str(path), start, motions, samples, truth, landmarks, between=False)
    return timeline.recorded(world, reading, warnings)
