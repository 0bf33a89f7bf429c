"""Files of another program's numbers, held against what the reference makes of a scene."""

from dataclasses import dataclass, replace
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.source import mistake
from ekfsim.filters.belief import Gaussian
from ekfsim.localization import filter_of, first_belief, localize
from ekfsim.records import Entry
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.student.comparing.found import Found, found
from ekfsim.student.printed.narrative.found import NarrativeFound, examined
from ekfsim.student.printed.narrative.reading import narrative
from ekfsim.student.printed.results import results
from ekfsim.student.printed.steps import PrintedSteps
from ekfsim.student.printed.table import table

MANY = 0.8  # of the steps
EVERY = float("inf")  # σ; whatever agrees as far as its digits go is a witness


@dataclass(frozen=True)
class Held:
    """What is found in a table of results, and what its reader should know of it."""

    found: Found
    remarks: tuple[str, ...]


def held_table(scene: Scene, path: Path, against: str) -> Held:
    """A table of results. Raises UsageError where it cannot be read, or is of another run."""
    scene = _of_classroom(scene, against)
    entries, first = _entries(scene), first_belief(scene)
    expected = _expected(scene, entries, first)
    if not expected:
        raise UsageError(f"{scene.commands_source}: has no move and no reading to be compared")
    read = results(table(path), list(expected), expected)
    steps = PrintedSteps(read, filter_of(scene))
    seen = found([(scene.run, steps.compared(entries, first))], steps.gives, EVERY)
    remarks = [*read.remarks, *steps.unjudged()]
    if seen.differing > MANY * seen.steps:
        remarks.append(f"{path}: nearly every step differs: is it of this --seed, --run, --log?")
    return Held(seen, tuple(remarks))


def held_narrative(scene: Scene, path: Path, against: str) -> NarrativeFound:
    """A narrative. Raises UsageError where it cannot be read, InputError where nothing in it can be
    calculated.
    """
    scene = _of_classroom(scene, against)
    told = narrative(path)
    found = examined(told, _entries(scene), first_belief(scene), filter_of(scene))
    if not found.checked and not found.wrong:
        right = "they stand in lines like 'New state estimate is (x, y, theta) = (1.2, 0.5, 90)'"
        raise mistake(told.file, 1, 1, "no number in it follows from others in it", right)
    return found


def _of_classroom(scene: Scene, against: str) -> Scene:
    if not scene.commanded:
        wrong = f"is of the system '{scene.world.system}'; results in files are the classroom's"
        raise UsageError(f"{scene.commands_source}: {wrong}: compare a filter with --filter")
    return replace(scene, filter=against, beside=())


def _entries(scene: Scene) -> list[Entry]:
    return list(simulate(scene) if scene.log is None else scene.log.entries)


def _expected(scene: Scene, entries: list[Entry], first: Gaussian) -> dict[int, Gaussian]:
    """What the reference believes after each move and each beam."""
    steps = localize(entries, filter_of(scene), first, scene.guard, scene.world.layout)
    return {
        step.entry.index: Gaussian(*step.posterior)
        for step in steps
        if step.entry.given is not None
    }
