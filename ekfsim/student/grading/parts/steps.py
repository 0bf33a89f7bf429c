"""Each step of a student's filter beside the reference, from the student's own belief."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

from ekfsim.files.keys.homework import Partial, StepsKeys
from ekfsim.localization import first_belief
from ekfsim.records import Control
from ekfsim.student.asked import Asked, Caller
from ekfsim.student.comparing.compare import Compared, compare
from ekfsim.student.comparing.difference import in_sigmas
from ekfsim.student.comparing.found import Found, found
from ekfsim.student.comparing.naming import At
from ekfsim.student.fault import FaultError
from ekfsim.student.grading.bench import Bench, tells
from ekfsim.student.grading.scores import Scored, Shown
from ekfsim.student.mistakes.guessing import Guess
from ekfsim.student.mistakes.mistake import elsewhere

Said = Callable[[str], str]


@dataclass
class Counts:
    """Steps of one kind, moves or readings, in all runs."""

    right: int = 0
    seen: int = 0
    of: int = 0  # in which a right filter has something to do

    @property
    def share(self) -> float:
        """Of what there is to be right, and of what was asked beyond it."""
        return self.right / max(self.of, self.seen)


def graded_steps(score: Scored, keys: StepsKeys, bench: Bench, caller: Caller) -> Scored:
    """How many steps of a scene are right, and what is wrong with the first that is not."""
    name = score.check.about
    moves, readings = Counts(), Counts()
    faults: list[tuple[int, FaultError]] = []  # of single steps, each with its run
    runs = bench.runs(name, keys.runs)
    for run in runs:
        reached = bench.reached(name, run, keys.against)
        moves.of += reached.moves
        readings.of += reached.readings

    def kind_of(asked: Asked) -> Counts:
        return moves if isinstance(asked.given, Control) else readings

    def compared(run: int) -> Iterator[Compared]:
        scene = bench.scene(name, run)
        reference = bench.reference(name, run, keys.against)
        entries, first = bench.entries(name, run), first_belief(scene)
        layout, guard = scene.world.layout, scene.guard

        def failed(asked: Asked, fault: FaultError) -> None:
            kind_of(asked).seen += 1
            faults.append((run, fault))

        for step in compare(entries, first, caller, reference, layout, guard, failed):
            kind = kind_of(step.asked)
            if tells(step, layout):
                kind.seen += 1
                kind.right += not step.differences
            yield step

    result = found((run, compared(run)) for run in runs)
    if faults:
        result = replace(result, fault_run=faults[0][0], fault=faults[0][1])
    share = _share(keys.partial, result, [kind for kind in (moves, readings) if kind.of])
    told = _words(
        result, max(len(faults) - 1, 0), moves, readings, len(runs),
        str if bench.scene(name, runs[0]).commanded else elsewhere,
    )  # fmt: skip
    shown = (Shown(one.name, name, seen.steps) for one, seen in result.named.items())
    return replace(
        score,
        words=tuple(told),
        fault="" if result.fault is None else str(result.fault),
        first_wrong="" if result.first is None else _where(name, result.first, len(runs)),
        shown=tuple(shown),
    ).earned(share)


def _share(partial: Partial, result: Found, kinds: list[Counts]) -> float:
    """The share of the points. All of it only where everything is right."""
    if result.equal and all(kind.right == kind.of == kind.seen for kind in kinds):
        return 1.0
    if partial == "none" or not kinds:
        return 0.0
    if partial == "halves":
        share = sum(kind.share for kind in kinds) / len(kinds)
    else:
        share = sum(k.right for k in kinds) / sum(max(k.of, k.seen) for k in kinds)
    return min(share, 1 - 1e-9)


def _where(scene: str, at: At, runs: int) -> str:
    run = f" run {at.run}" if runs > 1 else ""
    return f"{scene}{run}: {at.step.asked.step}"


def _words(
    result: Found, failures: int, moves: Counts, readings: Counts, runs: int, said: Said
) -> Iterator[str]:
    """What is found, the first fault and the first wrong number first.

    failures : how many more steps fail      said : what is said of a mistake, in whose names
    """
    if result.fault is not None:
        run = f"run {result.fault_run}: " if runs > 1 else ""
        yield f"the code failed: {run}{result.fault}"
    if failures:
        yield f"it fails at {failures} more step{'s' * (failures > 1)}"
    if result.first is not None:
        step = result.first.step
        most, more = step.most, len(step.differences) - 1
        others = f"; {more} more entr{'y differs' if more == 1 else 'ies differ'}" if more else ""
        run = f"run {result.first.run}, " if runs > 1 else ""
        yield (
            f"first wrong number: {run}{step.asked.step}: {most.entry} is {most.theirs:.9g}, "
            f"where {most.right:.9g} is right: {in_sigmas(most.size)}{others}"
        )
        yield from _guessed(result.guesses, said)
    if result.ended is not None:
        yield f"{result.ended.step.asked.step}: {result.ended.step.unusable}"
    guessed = {one for guess in result.guesses[:1] for one in guess}
    for mistake, seen in result.named.items():
        if mistake not in guessed:
            where = seen.first.step.asked.step
            told, read = said(mistake.told), said(mistake.read)
            yield f"also, at {seen.steps} steps, the first {where}: {told}; {read}"
    for what, kind in (("moves", moves), ("readings", readings)):
        if kind.of and not (result.equal and kind.right == kind.of == kind.seen):
            never = kind.of - kind.seen
            why = f"; for {never} of them its own belief left nothing to do" if never > 0 else ""
            yield f"{kind.right} of {max(kind.of, kind.seen)} {what} are right{why}"
    if result.equal:
        yield f"all {result.steps} steps are right, to {result.largest:.1g} σ"


def _guessed(guesses: Iterable[Guess], said: Said) -> Iterator[str]:
    best, *others = [*guesses] or [()]
    for mistake in best:
        yield f"{mistake.name}: {said(mistake.told)}; read again {said(mistake.read)}"
    if others:
        names = ", or ".join(" with ".join(one.name for one in guess) for guess in others[:3])
        yield f"it could as well be {names}"
