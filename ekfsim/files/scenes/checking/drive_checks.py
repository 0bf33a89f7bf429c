"""What of a commands file no single key can tell: its drive, and whether the world's robot can.

What drives are made of is imported where there is one.
"""

import math
from collections.abc import Iterator

from ekfsim.errors import Mistake
from ekfsim.files.keys.commands import WAYS, CommandsKeys
from ekfsim.files.keys.fields import aliases
from ekfsim.files.keys.recorded.recording import OF_ANY_ROBOT, OWN_KEYS, misfit
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.scenes.playing import drive_of
from ekfsim.files.yaml.telling import meant
from ekfsim.systems.drive import Drive
from ekfsim.world import World


def check_ways(file: Sound) -> Iterator[Mistake]:
    """A commands file without anything to do, or with two; a path with keys of another."""
    held = [way for way in file.root.keys if way in WAYS]
    if not held and not any(meant(key, "commands", ()) in WAYS for key in file.root.keys):
        wrong, right = "the file says nothing to do", f"write one of {', '.join(WAYS)}"
        yield file.mistake((), wrong, right)
    for second in held[1:]:
        wrong = f"'{held[0]}' on line {file.root.keys[held[0]][0]} says already what happens"
        yield file.mistake((second,), wrong, "keep one of them")
    yield from check_path(file)


def check_path(file: Sound) -> Iterator[Mistake]:
    """A path with keys of another, with a broken lap, or with more rounds than fit."""
    path, drive = file.value("drive", "path"), file.root.at(("drive",))
    if path is None or drive is None:
        return
    from ekfsim.files.keys.drive import MAX_ROUNDS, PathKeys
    from ekfsim.files.keys.worlds.documents import fields_of
    from ekfsim.systems.drives import DRIVES, Spiral

    names = aliases(PathKeys)
    known = ["path", *(names[name] for name in fields_of(DRIVES[path]))]
    foreign = [key for key in drive.keys if key in names.values() and key not in known]
    for key in foreign:
        yield file.mistake(
            ("drive", key), f"a {path} has no key '{key}'", f"it has: {', '.join(known)}"
        )
    laps = file.value("drive", "laps")
    if path == "square" and laps is not None and laps != int(laps):
        yield file.mistake(
            ("drive", "laps"), f"{laps} is no whole number of squares", f"write {max(int(laps), 1)}"
        )
    if path == "spiral" and (way := file.value("drive")) is not None:
        width, length = way.get("width", Spiral.width), way.get("length", Spiral.length)
        spacing = way.get("spacing", Spiral.spacing)
        rounds = 0.4 * min(width, length) / spacing
        if rounds > MAX_ROUNDS:
            wrong = f"so near to each other, there are {rounds:.0f} rounds, more than {MAX_ROUNDS}"
            yield file.mistake(
                ("drive", "spacing"),
                wrong,
                f"write at least {0.4 * min(width, length) / MAX_ROUNDS:g}",
            )
    if foreign:
        file.give_up(("drive",))  # it cannot be driven: how long it takes is not asked


def check_fit(file: Sound, keys: CommandsKeys, world: World) -> Iterator[Mistake]:
    """A commands file whose robot the world does not have,
    and drives too long or too short for it.
    """
    system = world.system
    if keys.commands is not None and world.robot is not None:
        wrong = f"the robot of the system '{system}' obeys no commands"
        yield file.mistake(
            ("commands",), wrong, "write 'drive' or 'recording', or name a world of the classroom"
        )
    elif keys.drive is not None:
        if world.robot is None:
            wrong = "the classroom's robot is not driven, it obeys commands"
            yield file.mistake(
                ("drive",), wrong, "write 'commands', or name a world of another system"
            )
        elif file.value("drive") is not None:
            yield from check_length(file, drive_of(keys.drive), world.robot.rate)
            yield from check_delays(file, world)
    elif keys.recording is not None and (wanted := misfit(keys.recording.format, system)):
        wrong = (
            f"a '{keys.recording.format}' log is of the system '{wanted}', the world of the "
            f"system '{system}'"
        )
        right = f"name a world of the system '{wanted}'"
        if keys.recording.format in OF_ANY_ROBOT:
            format = keys.recording.format
            wrong = f"the world is of the classroom, whose robot leaves no '{format}' log"
            right = (
                "write in it, in place of noise:, system: landmarks (or ranges, gnss …) and its "
                "sensors, for a laser among its walls sensors: [{ultrasonic: {range: 10}}]"
            )
        yield file.mistake(("recording", "format"), wrong, right)
    if keys.recording is not None:
        known = OWN_KEYS.get(keys.recording.format, ())
        for format, own in OWN_KEYS.items():
            for key in own:
                if key not in known and file.root.at(("recording", key)) is not None:
                    wrong = f"a '{keys.recording.format}' log has columns and files of its own"
                    right = f"delete it, or write format: {format}"
                    yield file.mistake(("recording", key), wrong, right)
    if keys.recording is not None and keys.filter == "kf-nominal":
        yield file.mistake(
            ("filter",), "a recording does not tell the way that was planned", "write kf or ekf"
        )


def check_delays(file: Sound, world: World) -> Iterator[Mistake]:
    """A filter that takes readings for older than they are, and so before they are made."""
    for true, told in zip(world.instruments, world.told_instruments, strict=True):
        if told.delay > true.delay:
            wrong = (
                f"the filter takes readings of '{true.called}' for {told.delay - true.delay:g} s "
                "older than they are, and would use them before they are made"
            )
            right = f"write at most {true.delay:g} as the delay in the world's belief.sensors"
            yield file.mistake(("drive",), wrong, right)


def check_length(file: Sound, drive: Drive, rate: float) -> Iterator[Mistake]:
    """Drives of no step at all, and those that never end."""
    from ekfsim.files.keys.drive import MAX_STEPS

    steps = steps_of(drive, rate)
    if steps > MAX_STEPS:
        number = f"{steps:,.0f}".replace(",", " ") if steps < 1e12 else f"about {steps:.0e}"
        wrong = f"the drive takes {number} steps at the robot's {rate:g} Hz, more than 1 000 000"
        yield file.mistake(("drive",), wrong, "drive a shorter while, or lower the robot's rate")
    elif round(steps) < 1:
        wrong = f"the drive ends before the robot's first step, at {rate:g} Hz"
        yield file.mistake(("drive",), wrong, f"drive at least {1 / rate:g} s")


def steps_of(drive: Drive, rate: float) -> float:
    """How many steps a drive takes, about, without taking them."""
    from ekfsim.systems.drives import Circle, Spiral, Square, Stretches

    match drive:
        case Spiral():
            return drive.duration * rate
        case Square():
            side, turn = drive.side / drive.speed, math.pi / 2 / drive.turn_rate
            return 4 * drive.laps * (max(side * rate, 1) + max(turn * rate, 1))
        case Circle():
            return max(2 * math.pi * drive.radius * drive.laps / drive.speed * rate, 1)
        case Stretches():
            return math.fsum(stretch.duration for stretch in drive.stretches) * rate
    raise AssertionError(drive)
