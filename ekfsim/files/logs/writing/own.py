"""A simulated run → the files of the format that its robot's own logs have."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.logs.formats.pylon import CLOCK, EARTH_RADIUS
from ekfsim.files.logs.writing.ticks import Run, as_written, numbered
from ekfsim.models.sensors.mounted import place_of
from ekfsim.models.sensors.offset import from_global
from ekfsim.scene import Scene

BEGINNING = 1_600_000_000  # s, Unix, at which a simulated pylon log begins
YAWS = "compass", "gyro"
GPS_ORIGIN = (47.0, 8.0)  # degrees, of latitude and longitude: where its GPS takes (0, 0) to lie

Files = dict[str, str]  # the text of each file, by its name
Writer = Callable[[Scene, Run, Path], Files]


def _mower(scene: Scene, run: Run, out: Path) -> Files:
    """Poselog, angles and map.

    The listing's filter starts at the pose of row 1 and then makes row 1's time update, so that row
    holds the pose at which the filter of the run started, and every other the true pose after its
    own motion. Cameras look half a step before the stamp of the row at which they are used.
    """
    poses, angles, delays = list[list[float | int]](), list[list[float | int]](), _delays(scene)
    row_of = {mark.id: row for row, mark in enumerate(scene.world.landmarks)}
    for n, tick in enumerate(run.ticks):
        left, right, ω, dt = tick.u.tolist()
        pose = (tick.truth if n else scene.world.told.start).tolist()
        poses.append([n + 1, 0, tick.t, left, right, 0, 0, 0, ω, *[0] * 9, *pose])
        for reading in tick.readings:
            _, id = numbered(reading, ("marker",), out)
            stamp = tick.t - dt / 2 + delays[reading.name]
            angles.append([stamp, row_of[id], *reading.z.tolist()])
    return {
        "marker-001-poselog.txt": as_written(poses, " "),
        "marker-001-003-angles.txt": as_written(angles, " "),
        "marker-001-map.txt": as_written(scene.world.landmarks, " "),
    }


def _gnss(scene: Scene, run: Run, out: Path) -> Files:
    """Wheel speeds, each row's since the row before it;
    fixes and true poses at the stamps of the wheels.
    """
    wheels, fixes = list[list[float]](), list[list[float]]()
    delays = _delays(scene)
    for tick in run.ticks:
        left, right, _ = tick.u.tolist()
        if not wheels:
            wheels.append([run.t, right, left])
        wheels.append([tick.t, right, left])
        for reading in tick.readings:
            numbered(reading, ("gnss",), out)
            fixes.append([tick.t + delays[reading.name], *reading.z.tolist()])
    return {
        "wheelspeeds.csv": as_written(wheels, ",", "t,vr,vl"),
        "gnss.csv": as_written(fixes, ",", "t,x,y"),
        "groundtruth.csv": _truth(run, "phi"),
    }


def _pylon(scene: Scene, run: Run, out: Path) -> Files:
    """One row a tick: the pylon in the lidar's frame, or nan;
    stamps in whole microseconds, in plain digits.
    """
    rows = list[list[float | int]]()
    if any(_delays(scene).values()):
        wrong = "a row of this robot's log is stamped once, for its motion and for its reading"
        raise UsageError(f"{out}: {wrong}; take the 'delay' out of the world")
    for tick in run.ticks:
        ahead, left, θ, _ = tick.u.tolist()
        x = y = math.nan
        for reading in tick.readings:
            kind, _ = numbered(reading, ("pylon", "lidar"), out)
            facing = place_of(reading.sensor, np.array([0.0, 0.0, θ]))[2]
            x, y = (from_global(reading.z, facing) if kind == "pylon" else reading.z).tolist()
        stamp = (BEGINNING + int(tick.t)) * CLOCK + round(tick.t * 1e6) % CLOCK
        latitude, longitude = _degrees(*((0.0, 0.0) if tick.fix is None else tick.fix.tolist()))
        yaw = math.degrees(-θ) % 360
        rows.append([x, y, 0.0, stamp, latitude, longitude, yaw, 0.0, 0.0, ahead, left, 0.0])
    return {"pylon.csv": as_written(rows, ",", ending=",")}


def _delays(scene: Scene) -> dict[str, float]:
    """How old the readings of each sensor are when they are stamped, as the filter is told, in s"""
    return {target.name: target.delay for _, target in scene.world.targets(scene.reading)}


def _degrees(x: float, y: float) -> tuple[float, float]:
    """Latitude and longitude of a place x m east and y m north of the GPS's origin."""
    latitude, longitude = GPS_ORIGIN
    metre = math.degrees(1 / EARTH_RADIUS)
    return latitude + y * metre, longitude + x * metre / math.cos(math.radians(latitude))


def _pioneer(scene: Scene, run: Run, out: Path) -> Files:
    """The ways of the wheels since the row before, which the first row, the start, has not; beams,
    and yaws in rad.
    """
    ways, read = [[run.t, 0.0, 0.0]], dict[str, list[list[float | int]]](ultrasonic=[], infrared=[])
    yaws = {
        name: list[list[float]]()
        for name in YAWS
        if any(i.name == name for i in scene.world.instruments)
    }
    delays = _delays(scene)
    for tick in run.ticks:
        left, right, *dt = tick.u.tolist()  # a skid-steered robot is given speeds and dt
        span = dt[0] if dt else 1.0
        ways.append([tick.t, left * span, right * span])
        for reading in tick.readings:
            kind, beam = numbered(reading, (*read, *yaws), out)
            stamp = tick.t + delays[reading.name]
            if kind in yaws:
                yaws[kind].append([stamp, *reading.z.tolist()])
            else:
                read[kind].append([stamp, beam, *reading.z.tolist()])
    return {
        "odometry.csv": as_written(ways, ",", "t,left,right"),
        "ultrasonic.csv": as_written(read["ultrasonic"], ",", "t,beam,range"),
        "infrared.csv": as_written(read["infrared"], ",", "t,pair,intensity"),
        **{f"{name}.csv": as_written(rows, ",", "t,yaw") for name, rows in yaws.items()},
        "groundtruth.csv": _truth(run, "heading"),
    }


def _truth(run: Run, heading: str) -> str:
    """The true poses, from the start on."""
    rows = [[run.t, *run.truth.tolist()], *([tick.t, *tick.truth.tolist()] for tick in run.ticks)]
    return as_written(rows, ",", f"t,x,y,{heading}")


WRITERS: dict[str, Writer] = {"mower": _mower, "gnss": _gnss, "pylon": _pylon, "pioneer": _pioneer}
