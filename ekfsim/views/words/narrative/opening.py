"""The head of a narrative: what is run, and the numbers that all others come from, as they are and
as they are told.
"""

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

from ekfsim.filters.choice import kind_of
from ekfsim.filters.place import forward, label
from ekfsim.filters.tuning import reads
from ekfsim.models.sensors.mounted import Mount
from ekfsim.provenance import told_in_a_line
from ekfsim.scene import Scene
from ekfsim.systems.estimating import STATES, Estimating
from ekfsim.systems.robot import Robot
from ekfsim.views.words.numbers import number, pose
from ekfsim.world import Noise

RATIOS = {  # as the files call them
    "execution_distance": "executionDstSigmaRatio",
    "execution_angle": "executionAngSigmaRatio",
    "odometry_distance": "odometryDstSigmaRatio",
    "odometry_angle": "odometryAngSigmaRatio",
    "range": "rangeSigmaRatio",
}
SELDOM = "delay", "mount_x", "mount_y", "mount_theta"  # told where they are not 0
LINEARISED = ("kf", "kf-nominal", "ekf", "iekf", "huber", "pdaf", "adaptive", "invariant")
WEIGHING = ("huber", "pdaf")  # their readings
BOTH = (
    "A gate and a weight judge each reading: one beyond the gate is refused outright, and only the "
    "others are weighed"
)
UNTAUGHT = (
    "A reading beyond the gate teaches nothing of the noise: what is learnt comes from the others, "
    "and is too small"
)
NO_IDEA = "The filter has no idea where the robot starts: it may be anywhere on the floor"
PERFECT = (
    "The filter is told that the range has no noise: each beam leaves no doubt along its "
    "derivatives, which hold for "
    "the estimate alone, so that it may soon claim certainty where it errs"
)


def opening(scene: Scene) -> str:
    """What is run, the noise and the start, and what should be known of the filter and of the
    document's reading.
    """
    told = [told_in_a_line(scene), *filter(None, [plain(scene.description)]), "", *_numbers(scene)]
    if remark := kind_of(scene.filter).remark:
        told.append(f"The filter {label(scene.filter)}: {remark}")
    if reads(scene.filter, "particles"):
        most = "at most " if forward(scene.filter) == "amcl" else ""
        told.append(
            f"The filter {scene.filter}: {most}{scene.tuning.crowd(scene.filter)} particles"
        )
    if scene.world.told.start_unknown:
        told.append(NO_IDEA)
    if reads(scene.filter, "hypotheses"):
        told.append(f"The filter {scene.filter}: {_hypotheses(scene)}")
    if scene.gate is not None and forward(scene.filter) in WEIGHING:
        told.append(BOTH)
    if scene.gate is not None and forward(scene.filter) == "adaptive":
        told.append(UNTAUGHT)
    if scene.world.perfect_beam and forward(scene.filter) in LINEARISED:
        told.append(PERFECT)
    if scene.reading != "corrected":
        told.append(_followed(scene))
    return "".join(f"{line}\n" for line in told)


def _hypotheses(scene: Scene) -> str:
    """How many Gaussians the filter may keep, and what is told of them; only the classroom's laser
    says which walls its beam may meet (`Parting`).
    """
    if scene.world.robot is not None:
        return (
            "no sensor here tells which of several walls it may have met, so that there is one "
            "hypothesis, and it is the EKF"
        )
    return (
        f"{scene.tuning.hypotheses} hypotheses at most; it is judged by the mean and covariance of "
        "all, and a reading's numbers are those of the heaviest"
    )


def plain(text: str) -> str:
    r"""A text in plain lines, all but the first indented: none is taken for a line of ours.

    >>> print(plain("Look!\n==>The robot moved"))
    Look!
       ==>The robot moved
    """
    return "\n   ".join(text.strip().splitlines())


def _numbers(scene: Scene) -> Iterator[str]:
    """Noise and start as they are, where that is known, and where the filter is told otherwise, as
    it is told.
    """
    world, simulated = scene.world, scene.log is None
    if world.robot is None:
        yield from _both("The noise ratios", world.noise, world.told.noise, simulated)
    else:
        yield "The numbers of robot and sensors are in m, s, rad and V"
        told_robot, found = told_apart(world.told_robot)
        yield from _both(f"The robot ({world.system})", world.robot, told_robot, simulated)
        yield from found
        for true, told in zip(world.instruments, world.told_instruments, strict=True):
            yield from _both(f"Sensor {true.called}", true, told, simulated)
    if simulated:
        about = ""
        if world.start_sigma.any():
            about = (
                f", each run about it with the standard deviations "
                f"{pose(world.start_sigma.tolist())}"
            )
        yield f"The robot starts at (x, y, th) = {pose(world.start.tolist())}{about}"


def told_apart(robot: Robot | None) -> tuple[Robot | None, list[str]]:
    """The robot's own numbers, and what the filter is to find out beside its pose."""
    if not isinstance(robot, Estimating):
        return robot, []
    found = ", ".join(f"{STATES[name]} ({_listed(one._asdict())})" for name, one in robot.estimates)
    return robot.robot, [f"The filter is to find as well: {found}"]


def _both(what: str, true: Any, told: Any, known: bool) -> Iterator[str]:
    """Numbers of a record as they are, and those of them that the filter is told otherwise."""
    as_is, other = _values(true), _values(told)
    for name in SELDOM:
        if not as_is.get(name) and not other.get(name):
            as_is.pop(name, None)
            other.pop(name, None)
    if known:
        yield f"{what}: {_listed(as_is)}"
        other = {name: value for name, value in other.items() if value != as_is.get(name)}
    if other:
        yield f"{what}, as the filter is told: {_listed(other)}"


def _values(record: Any) -> dict[str, float]:
    """The numbers of a record by the names that people know."""
    named = {
        RATIOS[f.name] if isinstance(record, Noise) else f.name: getattr(record, f.name)
        for f in fields(record)
    }
    if isinstance(mount := named.pop("mount", None), Mount):
        named |= {f"mount_{axis}": value for axis, value in mount._asdict().items()}
    return {name: value for name, value in named.items() if isinstance(value, int | float)}


def _listed(values: dict[str, float]) -> str:
    return ", ".join(f"{name}={number(value)}" for name, value in values.items())


def _followed(scene: Scene) -> str:
    """What a reading of the document changes in a run of this robot and its instruments."""
    if scene.world.follows(scene.reading):
        return f"The equations are those of the document as {scene.reading}, not the corrected ones"
    return (
        f"Of the equations that this run uses none is {scene.reading} otherwise: they are the "
        f"corrected ones"
    )
