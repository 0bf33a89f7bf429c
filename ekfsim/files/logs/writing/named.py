"""A simulated run → the files of the format `log`: all that the filter is given and told, and the
truth.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from ekfsim.files.logs.named.readings import Fitting, fittings_of
from ekfsim.files.logs.tables.names import named
from ekfsim.files.logs.writing.ticks import Run
from ekfsim.files.logs.writing.told_world import driven_world
from ekfsim.records import Reading
from ekfsim.scene import Scene


def files_of(scene: Scene, run: Run) -> dict[str, str]:
    """The text of each file, by its name."""
    landmarks = scene.world.landmarks
    files = {
        "motion.csv": _motion(scene, run),
        "readings.csv": _readings(scene, run),
        "truth.csv": _truth(run),
        "world.yaml": "".join(driven_world(scene)),
    }
    if landmarks:
        rows = ([str(mark.id), repr(mark.x), repr(mark.y)] for mark in landmarks)
        files["landmarks.csv"] = _table({"id": "", "x": "m", "y": "m"}, rows)
    return files


def _motion(scene: Scene, run: Run) -> str:
    """The inputs of the robot, each at the end of its time, and a row for the start; speeds ahead
    and turn rates stand where they begin.
    """
    motion = scene.world.believed_robot.motion(scene.reading)
    u = np.array([tick.u for tick in run.ticks])
    t, still = [run.t, *(tick.t for tick in run.ticks)], np.zeros((1, u.shape[1]))
    match motion.inputs[0].name:
        case "left":
            unit, gyro = motion.inputs[0].unit, {"omega": "rad/s"} if u.shape[1] > 3 else {}
            columns, rows = {"left": unit, "right": unit, **gyro}, np.vstack([still, u])
        case "distance":
            columns, rows = {"distance": "m", "turn": "rad"}, np.vstack([still, u])
        case "speed":
            columns, rows = {"v": "m/s", "omega": "rad/s"}, np.vstack([u, still])
        case _:
            columns, rows, t = {"ax": "m/s²", "ay": "m/s²", "yaw": "rad"}, u, t[1:]
    values = np.column_stack([t, rows[:, : len(columns)]]).tolist()
    return _table({"t": "s", **columns}, ([repr(one) for one in row] for row in values))


def _readings(scene: Scene, run: Run) -> str:
    """What all sensors told, a row a reading, by its stamp; of one instant in the order in which
    the filter is given them.
    """
    known, fittings = _by_name(scene), _fittings(scene)
    units = dict[str, str]()
    for fitting in fittings:
        outputs = next(iter(fitting.targets.values())).sensor.outputs
        units.update(zip(fitting.columns, (one.unit for one in outputs), strict=True))
    several = {"target": ""} if any(fitting.only is None for fitting in fittings) else {}
    columns = {"t": "s", "sensor": "", **several, **units}
    rows = sorted(_rows(run, known, columns), key=lambda row: float(row[0]))
    return _table(columns, rows)


def _rows(
    run: Run, known: dict[str, list[tuple[Fitting, str]]], columns: Iterable[str]
) -> Iterator[list[str]]:
    for tick in run.ticks:
        for reading in tick.readings:
            fitting, key = _read_by(reading, known[reading.name])
            told = dict(zip(fitting.columns, fitting.told(reading.z).tolist(), strict=True))
            row = {
                "t": repr(tick.t + fitting.targets[key].delay),
                "sensor": fitting.instrument.called,
                "target": key if fitting.only is None else "",
                **{column: repr(one) for column, one in told.items()},
            }
            yield [row.get(column, "") for column in columns]


def _fittings(scene: Scene) -> list[Fitting]:
    """The sensors and what each tells of what it sees."""
    return fittings_of(scene.world, scene.reading, scene.world.landmarks, None)


def _by_name(scene: Scene) -> dict[str, list[tuple[Fitting, str]]]:
    """By the names of readings, what may have told them, and of what."""
    known = dict[str, list[tuple[Fitting, str]]]()
    for fitting in _fittings(scene):
        for key, target in fitting.targets.items():
            known.setdefault(target.name, []).append((fitting, key))
    return known


def _read_by(reading: Reading, known: list[tuple[Fitting, str]]) -> tuple[Fitting, str]:
    """What told a reading, and of what: of two pylons the name is one."""
    if len(known) == 1:
        return known[0]
    return next(
        (fitting, key) for fitting, key in known if fitting.targets[key].sensor == reading.sensor
    )


def _truth(run: Run) -> str:
    """The true poses, from the start on."""
    poses = [[run.t, *run.truth.tolist()], *([tick.t, *tick.truth.tolist()] for tick in run.ticks)]
    rows = ([repr(one) for one in pose] for pose in poses)
    return _table({"t": "s", "x": "m", "y": "m", "theta": "rad"}, rows)


def _table(columns: dict[str, str], rows: Iterable[list[str]]) -> str:
    """A table whose first line tells the units, where the reader knows them."""
    head = [f"{name} [{unit}]" if unit else name for name, unit in columns.items()]
    heads = [
        told if named(told)[1:] == (name, unit) else name
        for told, (name, unit) in zip(head, columns.items(), strict=True)
    ]
    return "".join(f"{','.join(row)}\n" for row in (heads, *rows))


def differences(scene: Scene, run: Run) -> list[str]:
    """What whoever reads the log makes otherwise of it."""
    known, missed = _by_name(scene), 0
    for tick in run.ticks:
        for reading in tick.readings:
            fitting, _ = _read_by(reading, known[reading.name])
            if "range" in fitting.columns and not fitting.is_beam:
                missed += bool(fitting.told(reading.z)[0] <= 0)
    if not missed:
        return []
    told = "1 reading has a range" if missed == 1 else f"{missed} readings have ranges"
    return [f"{told} of 0 m or less, which is none to a reader of logs: left out there"]
