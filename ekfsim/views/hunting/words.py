"""What a hunt found → sentences: the input, how often it does what is wanted, and how it was
found.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ekfsim.commands import Command, Kidnap, Move, Repeat, Say, Sense
from ekfsim.filters.place import label
from ekfsim.hunting.hunt import Hunted
from ekfsim.printable import in_a_line
from ekfsim.study.results import Result, Share
from ekfsim.views.words.text_table import folded
from ekfsim.world import Faults, World

UNITS: Mapping[str, str] = {"start.x": " m", "start.y": " m", "start.theta": "°"}  # of told numbers


def conclude(hunted: Hunted, files: Sequence[Path], repeated: str, width: int | None) -> str:
    """All that is said of a hunt.

    files : that were written; repeated : the command line that finds the same again
    """
    lines = [
        *folded(in_a_line(_headline(hunted)), width),
        *(f"  {told(command)}" for command in hunted.scene.commands),
        *(line for sentence in _sentences(hunted, repeated) for line in folded(sentence, width)),
        *folded(in_a_line(_written(files, hunted.result.worst)), width),
    ]
    return "".join(f"{line}\n" for line in lines)


def interrupted(hunted: Hunted, file: Path) -> str:
    """What is kept of a hunt that was interrupted, in a line."""
    looked = hunted.search.looked_at
    best = f"the best of {looked} lists" if looked else "the smallest change so far"
    return f"{best} is kept in {file}: {_done(hunted)}"


def description(hunted: Hunted) -> str:
    """What the file says of itself."""
    found = f"Found by a hunt: {_done(hunted)}."
    return "\n".join([found, *_truth(hunted.scene.world), *_beside(hunted)])


def told(command: Command) -> str:
    """A command as its file has it, on a line.

    >>> told(Move(1.5, math.radians(90))), told(Repeat(2, (Sense(math.radians(-45)),)))
    ('move 1.5 m, turn 90°', '2 times: sense at -45°')
    """
    match command:
        case Move(d, a, slip):
            slips = f", slip {slip:g}" if slip else ""
            return f"move {d:g} m, turn {math.degrees(a):.6g}°{slips}"
        case Sense(a):
            return f"sense at {math.degrees(a):.6g}°"
        case Say(text):
            return f"say: {in_a_line(text)}"
        case Kidnap(x, y, θ):
            return f"kidnap to x {x:g} m, y {y:g} m, {math.degrees(θ):.6g}°"
        case Repeat(times, commands):
            return f"{times} times: {'; '.join(map(told, commands)) or 'nothing'}"


def _headline(hunted: Hunted) -> str:
    n = len(hunted.scene.commands)
    what = f"{n} command{'' if n == 1 else 's'} in {hunted.scene.world.name}"
    return f"{what}: {_done(hunted)}"


def _done(hunted: Hunted) -> str:
    """What was wanted, and in how many runs it is so: of runs that are lost and not well off there
    may be many more.
    """
    asked = hunted.asked
    lost = f"{label(hunted.scene.filter)} is lost and more than {asked.off:g} m off"
    share = _share(Share(*hunted.fresh))
    match asked.goal:
        case "silent":
            return f"{lost}, with a ΣNIS inside its band, in {share}"
        case "apart":
            return f"{lost} more often than {label(str(asked.against))}, by {share}"
        case _:
            return f"{lost} in {share}"


def _sentences(hunted: Hunted, repeated: str) -> Iterator[str]:
    yield from _truth(hunted.scene.world)
    yield from _beside(hunted)
    yield (
        f"Measured with seed {hunted.scene.seed}, which the search has not seen; on its own draws, "
        f"seed {hunted.asked.scene.seed}, it was {_percent(hunted.count.share)}."
    )
    yield from _needed(hunted)
    if hunted.search.looked_at:
        yield _looked(hunted)
    if not hunted.is_shrunk:
        yield "Not shrunk to the end: there may be fewer commands and rounder numbers in it."
    if hunted.asked.change == "told" and hunted.end != "lists":
        yield "The clock ended it before every number was tried: a smaller change may do as much."
    elif hunted.end in ("seconds", "interrupted"):
        yield in_a_line(f"The clock ended it, not a count: {repeated} repeats it on any machine.")


def _needed(hunted: Hunted) -> Iterator[str]:
    """What each told number would have to be."""
    if hunted.asked.change == "start":
        x, y, θ = hunted.scene.world.start.tolist()
        yield f"Begun at x {x:g}, y {y:g}, heading {math.degrees(θ):.6g}°."
    for n, one in enumerate(hunted.needed):
        first = "Written: " if n == 0 else "As well: "
        unit = UNITS.get(one.told.key, "")
        yield f"{first}{one.told.key} told as {one.told.value:g}{unit}, {one.true:g}{unit} true."


def _truth(world: World) -> Iterator[str]:
    """Whether what the filter is told is true."""
    if wrong := list(_untrue(world)):
        yield f"Not all is as the filter is told: {', '.join(wrong)}."
    else:
        yield "Every number that the filter is told is true."


def _untrue(world: World) -> Iterator[str]:
    told = world.told
    if told.noise != world.noise:
        yield "its noise"
    if (told.start != world.start).any() or (told.sigma != world.start_sigma).any():
        yield "its start"
    if told.map is not world.map and list(map(str, told.map.outlines())) != list(
        map(str, world.map.outlines())
    ):
        yield "its map"
    if world.faults != Faults():
        yield "faults of the robot"


def _beside(hunted: Hunted) -> Iterator[str]:
    every = _share(hunted.result.last.lost)
    yield f"By their NEES alone, however near the truth, {every} are lost: --expect counts these."
    if hunted.against is not None:
        name, lost = label(hunted.against.case.scene.filter), hunted.against.last.lost
        yield f"On the same draws {name} loses {_share(lost)}."
    if (nis := _silence(hunted.result)) is not None:
        yield nis


def _silence(result: Result) -> str | None:
    """Whether the readings would tell."""
    of, runs = result.tally.of, result.tally.runs
    if not of.nis_readings:
        return "There is no reading in it: no NIS can tell."
    outside = Share(of.nis_above + of.nis_below, runs)
    return f"ΣNIS, which alone could tell, lies outside its 95 % band in {_share(outside)}."


def _looked(hunted: Hunted) -> str:
    search, asked = hunted.search, hunted.asked
    why = {
        "lists": "",
        "best": "; no list could be better",
        "seconds": f"; there were {asked.seconds:g} s",
        "interrupted": "; then it was interrupted",
    }[hunted.end]
    if hunted.end == "best" and asked.enough is not None:
        why = f"; {_percent(asked.enough)} were enough"
    return f"Looked at {search.looked_at} lists in {search.runs} runs{why}."


def _written(files: Sequence[Path], worst: int) -> str:
    first, *rest = files
    beside = f", with {rest[0]}" if rest else ""
    return (
        f"{first}{beside}: ekfsim play {first} shows a run, ekfsim study {first} --expect holds it "
        f"to its word, ekfsim why {first} --run {worst} asks what lost the worst run"
    )


def _share(share: Share) -> str:
    return f"{_percent(share.value)} of runs ({100 * share.low:.3g} to {100 * share.high:.3g})"


def _percent(value: float) -> str:
    return f"{100 * value:.3g} %"
