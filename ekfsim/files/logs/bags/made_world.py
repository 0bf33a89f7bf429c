"""A world for a bag, where nobody names one."""

from pathlib import Path

from ekfsim.files.given.given import Given
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.keys.recorded.topics import TopicsKeys
from ekfsim.files.logs.bags.opening import opened
from ekfsim.files.logs.bags.topics import topics_of

RECEIVER: list[dict[str, object]] = [{"gnss": {}}]
SYSTEM = "ranges"  # whose robot tells its way and turn, as the poses of an odometry do


def world_of_bag(path: Path, recording: RecordingKeys, warnings: list[str]) -> Given:
    """A world without walls or landmarks, with a receiver where the bag has fixes; which is told.

    Raises UsageError where there is no such bag.
    """
    with opened(path) as bag:
        chosen = topics_of(bag.connections, recording.topics or TopicsKeys(), path, [])
    sensors = RECEIVER if any(one.role == "fix" for one in chosen) else []
    warnings.append(
        f"{path}: no world is named: one is made, system: {SYSTEM}, sensors: "
        f"{'gnss' if sensors else 'none'}, with the noise that is usual there; say otherwise with "
        "--world, or with --set sensors.… and robot.…"
    )
    return Given.made_for(_world(sensors), f"{path} (its topics)")


def any_world() -> Given:
    """A world for a bag that is not named yet."""
    return Given.made_for(_world(RECEIVER), "a bag's topics")


def _world(sensors: list[dict[str, object]]) -> dict[str, object]:
    start = {"x": 0.0, "y": 0.0, "theta": 0.0}
    return {"name": "a made world", "system": SYSTEM, "start": start, "sensors": sensors}
