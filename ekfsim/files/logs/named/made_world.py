"""A world that fits a log's columns, where nobody names one."""

from collections.abc import Iterable
from pathlib import Path

from ekfsim.files.given.given import Given
from ekfsim.files.keys.recorded.columns import ReadingsKeys
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs.folder import find_any
from ekfsim.files.logs.named.files import files_of
from ekfsim.files.logs.named.inputs import WANTED, Form
from ekfsim.files.logs.named.motion import form_of
from ekfsim.files.logs.named.opening.opened import opened, opened_all
from ekfsim.files.logs.named.readings import WANTED as READINGS
from ekfsim.files.logs.named.tables import Table
from ekfsim.systems.robots import GnssMower

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
    source, motion = files.motion()
    form = form_of(opened(source, WANTED))
    system, robot = SYSTEM_FOR[form], dict[str, float]()
    if form == "wheels" and motion.width is not None:
        robot["halfTrack"] = motion.width / 2
    sensors = dict[str, dict[str, object]]()
    for table, keys in files.readings():
        sensors.update(_sensors(opened_all(table, READINGS)[0], keys))
    width = f" {GnssMower().half_track * 2:g} m between the wheels," * (
        form == "wheels" and not robot
    )
    warnings.append(
        f"{log}: no world is named, and no {WORLD} lies in it: one is made of the columns, system: "
        f"{system},{width} sensors: {', '.join(sensors) or 'none'}, with the noise that is usual "
        "there; say otherwise with --world, or with --set sensors.… and robot.…"
    )
    return Given.made_for(_world(system, robot, sensors.values()), f"{log} (its columns)")


def _sensors(table: Table, keys: ReadingsKeys) -> dict[str, dict[str, object]]:
    """The sensors that tell what a table holds, by their names, as a world file has them."""
    names = [keys.sensor] if keys.sensor else []
    if not names and table.has("sensor"):
        names = list(dict.fromkeys(table.all_words("sensor")))
    if not names:
        return {kind: _sensor(kind) for kind in _kinds(table)[:1]}
    found = {}
    for name in names:
        kind = name if name in SENSORS else next(iter(_kinds(table, name)), None)
        if kind is not None:
            found[name] = _sensor(kind, name)
    return found


def _sensor(kind: str, name: str = "") -> dict[str, object]:
    own: dict[str, object] = {"name": name} if name not in ("", kind) else {}
    return {kind: {**own, **KEYS.get(kind, {})}}


def _kinds(table: Table, sensor: str = "") -> list[str]:
    """The kinds of sensors that tell what a table holds; where it has rows of several, those of one
    are asked.
    """
    return [
        kind
        for kind, columns in SENSORS.items()
        if table.has(*columns) and (not sensor or table.holds(columns, "sensor", sensor))
    ]


def any_world() -> Given:
    """A world for a log that is not named yet."""
    return Given.made_for(_world(SYSTEM_FOR["speeds"]), "a log's columns")


def _world(
    system: str,
    robot: dict[str, float] | None = None,
    sensors: Iterable[dict[str, object]] | None = None,
) -> dict[str, object]:
    start = {"x": 0.0, "y": 0.0, "theta": 0.0}
    own: dict[str, object] = {"name": "a made world", "system": system, "start": start}
    if robot:
        own["robot"] = robot
    return own if sensors is None else {**own, "sensors": list(sensors)}
