"""What of a world's system no single key can tell."""

from collections.abc import Iterator
from dataclasses import fields

from ekfsim.errors import Mistake
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.yaml.marked import Path
from ekfsim.files.yaml.schema import schema_at
from ekfsim.files.yaml.telling import at, example, meant
from ekfsim.world import Faults, World


def check_system(file: Sound) -> Iterator[Mistake]:
    """Keys of a world file that its system does not read, or lacks."""
    system = system_of(file)
    if system == "classroom":
        yield from check_classroom(file)
        if file.root.keys.keys().isdisjoint(("faults", "sensors")):
            return  # most are read without a word of the other systems
    from ekfsim.files.scenes.checking.driven_checks import check_driven, check_faults, check_sensors

    if system == "classroom":
        known = [fault.name for fault in fields(Faults)]
        yield from check_faults(file, "the classroom's robot", known)
    elif system is not None:
        yield from check_driven(file, system)
    yield from check_sensors(file)


def system_of(file: Sound) -> str | None:
    """The system of a world file, None where it is told wrongly."""
    told = file.value("system")
    return (
        "classroom"
        if file.root.at(("system",)) is None
        else told
        if isinstance(told, str)
        else None
    )


def check_classroom(file: Sound) -> Iterator[Mistake]:
    """The classroom needs its noise, and has no other robot."""
    if file.root.at(("noise",)) is None and not any(
        meant(key, "world", ()) == "noise" for key in file.root.keys
    ):
        right = f"write noise: {example(schema_at('world', ('noise',)))}"
        yield file.mistake(("noise",), "the key is missing", right)
    for key, what in (("robot", "is told by 'noise'"), ("sensors", "carries a laser")):
        if file.root.at((key,)):
            right = f"delete '{key}', or write e.g. system: mower"
            yield file.mistake((key,), f"the classroom's robot {what}", right)
    for key in ("robot", "sensors"):
        if file.root.at(("belief", key)):
            wrong = (
                f"what is believed of the classroom's {'robot' if key == 'robot' else 'laser'} is "
                "told by 'noise'"
            )
            yield file.mistake(
                ("belief", key),
                wrong,
                f"delete '{key}', or write e.g. noise: {{rangeSigmaRatio: 0.02}}",
            )


def system_warnings(file: Sound, world: World, logged: bool) -> Iterator[str]:
    """Sensors that have nothing to see, or are read less often than they say;
    a log may bring its landmarks.
    """
    if not world.instruments:
        return
    from ekfsim.files.scenes.checking.driven_checks import doubts

    for index, instrument in enumerate(world.instruments):
        item = file.root.at(("sensors", index))
        path: Path = ("sensors", index, *item.keys) if item else ("system",)
        for wrong, right in doubts(instrument, world, logged):
            yield str(at(file.file, file.root.nearest(path).mark, path, wrong, right))
