"""What no single key can tell of a list of commands: one command an item, not too many in all."""

from collections.abc import Iterator

from ekfsim.errors import Mistake
from ekfsim.files.keys.commands import MAX_COMMANDS, CommandKeys
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.yaml.marked import Path

COMMANDS = list(CommandKeys.model_fields)


def check_commands(file: Sound) -> Iterator[Mistake]:
    """Mistakes of a commands file that lie between its keys."""
    yield from check_items(file, ("commands",), COMMANDS, "command")
    count = expanded(file, ("commands",))
    if count > MAX_COMMANDS:
        number = (
            f"{count:,}".replace(",", " ")
            if count < 10**12
            else f"about {float(min(count, 10**300)):.0e}"
        )
        wrong = f"the commands expand to {number}, more than 1 000 000"
        yield file.mistake(("commands",), wrong, "repeat fewer times")


def check_items(file: Sound, path: Path, known: list[str], what: str) -> Iterator[Mistake]:
    """Items that hold none of the known keys, or two."""
    for index in range(file.count(*path)):
        item = file.root.at((*path, index))
        if item is None or not isinstance(item.value, dict):
            continue
        held = [key for key in item.keys if key in known]
        if len(held) > 1:
            wrong = f"{' and '.join(repr(key) for key in held)} stand in one item"
            yield file.mistake(
                (*path, index), wrong, f"begin each {what} with '- ' on a line of its own"
            )
        elif not item.keys:
            yield file.mistake(
                (*path, index), f"the {what} is missing", f"write one of {', '.join(known)}"
            )
        yield from check_items(file, (*path, index, "repeat", "commands"), known, what)


def expanded(file: Sound, path: Path) -> int:
    """How many commands a list expands to, as far as it is right."""
    total = 0
    for index in range(file.count(*path)):
        repeat = (*path, index, "repeat")
        if file.root.at(repeat) is None:
            total += 1
        else:
            times = file.value(*repeat, "times")
            total += (times if times is not None else 1) * expanded(file, (*repeat, "commands"))
    return total
