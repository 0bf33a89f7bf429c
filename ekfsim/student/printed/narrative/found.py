"""A narrative, number by number: what is wrong in it, from the first line on."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from ekfsim.filters.belief import Gaussian
from ekfsim.filters.protocol import Filter
from ekfsim.records import Entry
from ekfsim.student.comparing.compare import Compared
from ekfsim.student.comparing.difference import unit
from ekfsim.student.comparing.found import found
from ekfsim.student.mistakes.guessing import fits
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.printed.narrative import hanging
from ekfsim.student.printed.narrative.beside import Beside, beside, measured, predicted, rows_of
from ekfsim.student.printed.narrative.hanging import AXES, RADIAN, Due, Printed
from ekfsim.student.printed.narrative.numbers import Wrong
from ekfsim.student.printed.narrative.reading import Block, Narrative
from ekfsim.student.printed.narrative.uncertainty import uncertainty
from ekfsim.student.printed.results import Results
from ekfsim.student.printed.steps import PrintedSteps

NUMBERS = {name: i for i, name in enumerate(AXES)}


@dataclass(frozen=True)
class NarrativeFound:
    """What is found in a narrative."""

    file: str
    steps: int
    checked: int  # numbers that were calculated from others
    wrong: tuple[Wrong, ...]  # in the order of their lines
    remarks: tuple[str, ...]  # sentences that its reader should know


class Examined:
    """The numbers of a narrative, examined one after another."""

    def __init__(self) -> None:
        self.checked = 0
        self.wrong: dict[tuple[int, str], Wrong] = {}

    def look(self, dues: Iterable[Due]) -> None:
        """Calculate what is due."""
        for check, numbers in dues:
            self.checked += 1
            if (wrong := check.wrong(numbers)) is not None:
                self.wrong.setdefault((wrong.line, wrong.what), wrong)

    def note(self, wrongs: Iterable[Wrong]) -> None:
        """What was found in another way; of one number the first is told."""
        for wrong in wrongs:
            self.wrong.setdefault((wrong.line, wrong.what), wrong)


def examined(
    told: Narrative, entries: Iterable[Entry], first: Gaussian, reference: Filter
) -> NarrativeFound:
    """What is wrong in a narrative, beside a run of `entries` that begins with `first`."""
    given = [entry for entry in entries if entry.given is not None]
    run, found = beside(told, given), Examined()
    entry_of = {id(block): entry for block, entry in run.entries}
    if run.same_run:
        _compare(found, told, run, given, first, reference)
    before = Printed()
    for block in told.blocks:
        found.note(hanging.no_numbers(block))
        entry = entry_of.get(id(block))
        _hang_together(found, block, before, entry if run.same_run else None)
        if entry is not None:
            if run.same_run:
                found.look(measured(block, entry))
            if block.kind == "sense":
                found.look(predicted(block, entry, before, reference))
        before = hanging.printed(block, before)
    wrong = sorted(found.wrong.values(), key=lambda one: one.line)
    steps = sum(block.kind in ("move", "sense") for block in told.blocks)
    return NarrativeFound(told.file, steps, found.checked, tuple(wrong), tuple(_remarks(told, run)))


def _hang_together(found: Examined, block: Block, before: Printed, entry: Entry | None) -> None:
    """What of one step can be held against itself. entry : of the run, where it is of one"""
    begun, after = hanging.begun_with(block, before), hanging.printed(block, before)
    found.look(hanging.carried_over(block, before))
    if block.kind == "move" and entry is None:
        found.look(hanging.moved(block, begun, block.facts.get("odometry")))
        found.look(hanging.moved_covariance(block, begun))
    if block.kind == "sense":
        found.look(hanging.sensed(block))
        if before.P is not None and after.P is not None:
            found.note(hanging.grown(before.P, after.P))
        if entry is None:
            found.look(hanging.revised(block, before))
            found.look(hanging.revised_covariance(block, before))
    if after.P is not None and block.kind != "other" and hanging.finite(after.P):
        found.look(hanging.shape(after.P))
        found.note(hanging.impossible(after.P))
        found.look(uncertainty(block, after.P))


def _compare(
    examined: Examined, told: Narrative, run: Beside, given: Sequence[Entry], first: Gaussian,
    reference: Filter,
) -> None:  # fmt: skip
    """State and covariance after each step beside the reference, from the belief before it."""
    start = told.blocks[0] if told.blocks[0].kind == "start" else None
    rows = rows_of(run.entries, start)
    steps = PrintedSteps(Results(told.file, rows, ()), reference)
    compared = list(steps.compared(given[: len(run.entries)], first))
    block_of = {entry.index: block for block, entry in run.entries}
    if start is not None:
        block_of[0] = start
    named = list(found([(0, compared)], steps.gives, float("inf")).named)
    for step in compared:
        examined.checked += 12 if step.asked.index else 0
        if step.differences:
            block = block_of[step.asked.index]
            examined.note(_wrongs(step, block, _explained(step, named, steps)))


def _explained(step: Compared, named: Sequence[Mistake], steps: PrintedSteps) -> Mistake | None:
    """The known mistake that explains a step, of those that are believed."""
    σ = unit(step.right)
    return next(
        (one for one in named if fits((one,), step.asked, step.theirs, σ, steps.gives)), None
    )


def _wrongs(step: Compared, block: Block, mistake: Mistake | None) -> Iterator[Wrong]:
    """Each entry that differs, at its line."""
    which = {"start": "first", "move": "new", "sense": "revised"}[block.kind]
    state, P = block.facts[f"{which} state"], block.facts[f"{which} covariance"]
    for one in step.differences:
        guess, read = ("", "") if mistake is None else (mistake.told, mistake.read)
        if one.entry.startswith("P_"):
            i, j = (NUMBERS[letter] for letter in one.entry[2:])
            yield Wrong(P[3 * i + j].line, one.entry, one.theirs, one.right, "", guess, read)
        else:
            i = NUMBERS[one.entry]
            scale = 1 / RADIAN if i == 2 else 1.0
            what, units = f"{one.entry} of the {which} state", ("m", "m", "degrees")
            yield Wrong(
                state[i].line, what, state[i].value, one.right * scale, units[i], guess, read
            )


def _remarks(told: Narrative, run: Beside) -> Iterator[str]:
    """What was held against the run, and what only against itself."""
    if run.stranger is not None and not run.entries:
        yield (
            f"{told.file}:{run.stranger.line}: this narrative is of another run: only what hangs "
            "together in it is checked"
        )
    elif run.stranger is not None:
        yield (
            f"{told.file}:{run.stranger.line}: from here on the commands are others: only what "
            "hangs together is checked"
        )
    elif not run.same_run:
        yield (
            f"{told.file}: the commands are those of the run, what was measured is not: only what "
            "hangs together is checked, and what is predicted in the map"
        )
    yield from _unread(told)


def _unread(told: Narrative) -> Iterator[str]:
    """Where no state or no covariance stands; a reading that is not used needs none."""
    for what in ("state", "covariance"):
        unread = [
            block
            for block in told.blocks
            if block.kind in ("move", "sense")
            and not (block.unused or block.no_echo or block.no_wall)
            and not any(f"{which} {what}" in block.facts for which in ("new", "revised"))
        ]
        if unread:
            steps = "1 step" if len(unread) == 1 else f"{len(unread)} steps, this the first"
            yield f"{told.file}:{unread[0].line}: no {what} can be read of {steps}"
