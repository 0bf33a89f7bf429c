"""How each mechanism is told of a robot that is driven: what was put right, with its numbers."""

from ekfsim.views.why.changes import joined, named
from ekfsim.why.records import Change, Explanation, Mechanism

TOLD = 4  # changes that are told by name
CLAUSES = {
    Mechanism.ODOMETRY_OVERTRUSTED: "The filter is told less noise of the motion than there is",
    Mechanism.ODOMETRY_DISTRUSTED: "The filter is told more noise of the motion than there is",
    Mechanism.SENSOR_OVERTRUSTED: "The filter is told less noise of the readings than there is",
    Mechanism.SENSOR_DISTRUSTED: "The filter is told more noise of the readings than there is",
    Mechanism.WHEEL_SCALE: "The robot misreads each way by the same factor, which is no noise",
    Mechanism.TURN_SCALE: "The robot misreads each turn by the same factor, which is no noise",
    Mechanism.MOTION_BIAS: "The robot misreads its motion by the same each time, which is no noise",
    Mechanism.SENSOR_BIAS: "Each reading is wrong by the same, which is no noise",
    Mechanism.OUTLIERS: "Some readings are far more wrong than the filter is told",
    Mechanism.MISPLACED_LANDMARK: "One landmark is not where the filter is told that it stands",
    Mechanism.LATE_READINGS: "The readings are older than the filter takes them to be",
    Mechanism.WRONG_ROBOT: "The filter is told a robot that is not this one",
    Mechanism.WRONG_SENSOR: "The filter is told an instrument that is not this one",
    Mechanism.WRONG_EQUATIONS: "The filter follows equations that are not the robot's",
    Mechanism.WRONG_START: "The robot does not start where the filter is told that it does",
    Mechanism.MISPLACED_WALL: "The filter's map is not the room's",
    Mechanism.HEADING_SPREAD: "The filter makes straight lines of what bends too much for that",
}


def because_driven(explanation: Explanation, mechanism: Mechanism) -> str:
    """Why a driven robot's run ended as it did, in a clause that begins a sentence."""
    clause = CLAUSES.get(mechanism, f"What there is of it: {mechanism.value}")
    if mechanism is Mechanism.HEADING_SPREAD or len(explanation.causes) > 1:
        return clause
    told = [_with_numbers(one) for one in explanation.cure[:TOLD]]
    return f"{clause}: {joined(told)}" if told else clause


def _with_numbers(change: Change) -> str:
    if change.kind == "guess":
        return f"it would fit with {change.name}"
    return f"{named(change)} ({change.told})" if change.told else named(change)
