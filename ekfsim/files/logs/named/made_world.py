"""A world that fits a log's columns, where nobody names one."""

from pathlib import Path

from ekfsim.files.given.given import Given
from ekfsim.files.keys.recording import RecordingKeys
from ekfsim.files.logs.folder import find_any
from ekfsim.files.logs.named.files import files_of
from ekfsim.files.logs.named.inputs import WANTED, Form
from ekfsim.files.logs.named.motion import form_of
from ekfsim.files.logs.named.readings import WANTED as READINGS
from ekfsim.files.logs.named.tables import Table, opened

WORLD = "world.yaml"
SYSTEM_FOR: dict[Form, str] = {
    "speeds": "landmarks",
    "wheels": "gnss",
    "way": "ranges",
    "pose": "ranges",
    "inertial": "pylon",
}
KEYS: dict[str, dict[str, float]] = {"range": {"scale": 1.0, "bias": 0.0}}  # a radio that is right
SENSORS = {  # by the columns that they read; the first that fits a table
    "rangeBearing": ("range", "bearing"),
    "markers": ("azimuth", "elevation"),
    "range": ("range",),
    "bearing": ("bearing",),
    "gnss": ("x", "y"),
    "lidar": ("right", "ahead"),
    "compass": ("yaw",),
}


def world_brought(log: Path, recording: RecordingKeys, warnings: list[str]) -> Path | Given:
    """The world in a log's folder, or one that is made to fit its columns, which is told.

    Raises UsageError where there is no such log, InputError where its columns name nothing.
    """
    files = files_of(log, recording)
    own = None if files.alone else find_any(files.folder, "the world", WORLD)
    if own is not None:
        return own
    motion, _ = files.motion()
    system = SYSTEM_FOR[form_of(opened(motion, WANTED))]
    kinds = dict.fromkeys(
        kind
        for source, keys in files.readings()
        if (kind := keys.sensor or sensor_for(opened(source, READINGS)))
    )
    warnings.append(
        f"{log}: no world is named, and no {WORLD} lies in it: one is made of the columns, system: "
        f"{system}, sensors: {', '.join(kinds) or 'none'}, with the noise that is usual there; "
        "say otherwise with --world, or with --set sensors.… and robot.…"
    )
    sensors = [{kind: KEYS.get(kind, {})} for kind in kinds]
    return Given.values(_world(system, sensors), f"{log} (its columns)")


def any_world() -> Given:
    """A world for a log that is not named yet."""
    return Given.values(_world(SYSTEM_FOR["speeds"]), "a log's columns")


def _world(system: str, sensors: object = None) -> dict[str, object]:
    start = {"x": 0.0, "y": 0.0, "theta": 0.0}
    own: dict[str, object] = {"name": "made of the log's columns", "system": system, "start": start}
    return own if sensors is None else {**own, "sensors": sensors}


def sensor_for(table: Table) -> str | None:
    """The kind of sensor that tells what a table holds, None where no kind does."""
    return next((kind for kind, columns in SENSORS.items() if table.has(*columns)), None)
