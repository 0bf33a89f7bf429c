"""What is found of a student's filter beside a reference, in words that fit into a mail."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ekfsim.diagnostics.nees import squared_mahalanobis
from ekfsim.geometry import Array
from ekfsim.printable import short
from ekfsim.records import Control
from ekfsim.student.comparing.compare import Compared
from ekfsim.student.comparing.difference import DIFFERENT, Difference, unit
from ekfsim.student.comparing.found import Found
from ekfsim.student.comparing.naming import At, Seen
from ekfsim.student.comparing.rounding import LEAST
from ekfsim.student.mistakes.guessing import Guess
from ekfsim.student.mistakes.mistake import elsewhere
from ekfsim.views.student.telling import apart, filled
from ekfsim.views.words.numbers import ROUNDING, cleared, count
from ekfsim.views.words.text_table import aligned

MOST_ENTRIES = 12  # that are told of a step; of more only so many
MOST_DECIMALS = 10  # that somebody rounds to
MOST_ALIKE = 3  # guesses that are told where several are as good


@dataclass(frozen=True)
class Sides:
    """Who is compared with whom, and in what."""

    theirs: str  # "mine.py"
    reference: str  # "ekf"
    made: str  # "ekfsim 0.1.0, world worlds/room.yaml, …": what makes it again
    classroom: bool = True  # whether equations have the assignment's numbers
    printed: bool = False  # whether theirs are the numbers of a file, with as many digits as it has


def told(found: Found, sides: Sides) -> str:
    """All that is found; every line ends in a newline."""
    parts = [_headline(found, sides)]
    if found.first is not None:
        parts += [_first(found, found.first, sides), _guesses(found, sides)]
        parts += _each(found, sides)
    if found.ended is not None:
        at = found.ended
        parts.append(
            f"After {_where(found, at)} no belief is left to go on from: {at.step.unusable}."
        )
    return "\n".join(f"{filled(part)}\n" for part in [*parts, sides.made])


def _headline(found: Found, sides: Sides) -> str:
    moves, readings = count(found.moves, "move"), count(found.readings, "reading")
    of = f"{count(found.steps, 'step')} ({moves}, {readings}) of {count(found.runs, 'run')}"
    ends = "its numbers end" if sides.printed else "its code fails"
    until = "" if found.fault is None else f"Before {ends}, "
    if not found.steps:
        return f"No step was compared: {ends if until else 'nothing was handed over'}."
    if found.first is None:
        every = "all " if found.steps > 1 else ""
        never = "" if sides.printed or until else ": update was never called"
        none = "" if found.readings else f" No reading was compared{never}."
        least = (
            "that is what its digits leave open" if sides.printed
            else f"one of {DIFFERENT:g} σ would be told"
        )  # fmt: skip
        return (
            f"{until}{sides.theirs} equals {sides.reference} at {every}{of}. The largest "
            f"difference is {found.largest:.1g} σ; {least}.{none}"
        )
    return f"{until}{sides.theirs} differs from {sides.reference} at {found.differing} of {of}."


def _first(found: Found, at: At, sides: Sides) -> str:
    """The first step that differs: from which belief, what was given, what came of it."""
    step = at.step
    asked = step.asked
    if asked.index == 0:
        return (
            f"First at {_where(found, at)}: it begins with another belief than it is given.\n"
            + (_table(step, sides.theirs, "given"))
        )
    name, value = ("u", asked.given.u) if isinstance(asked.given, Control) else ("z", asked.given.z)
    return (
        f"First at {_where(found, at)}. Each step begins with what {sides.theirs} believed before "
        "it; here, in m and rad:\n"
        f"  x = {_row(asked.x)}\n"
        f"{_matrix(asked.P)}"
        f"  {name} = {_row(value)}\n" + _table(step, sides.theirs, sides.reference)
    )


def _table(step: Compared, theirs: str, right: str) -> str:
    """The entries that differ."""
    theirs, right = short(theirs, 20), short(right, 20)
    rows = [(one.entry, *apart(one.theirs, one.right), _size(one)) for one in step.differences]
    rows = [("", theirs, right, "difference"), *rows[:MOST_ENTRIES]]
    lines = [f"  {line}\n" for line in aligned(rows, names=1)]
    if len(step.differences) > MOST_ENTRIES:
        lines.append(f"  and {len(step.differences) - MOST_ENTRIES} entries more\n")
    if (unit(step.right) == LEAST).any():
        lines.append(f"  (σ counts as {LEAST:g} where it is less)\n")
    return "".join(lines)


def _guesses(found: Found, sides: Sides) -> str:
    """What explains the first wrong numbers."""
    assert found.first is not None
    if found.first.step.asked.index == 0:
        given = "the world tells them" if sides.printed else "they are given to the class"
        lines = [f"Guess: {_told(guess, sides)}" for guess in found.guesses]
        return "\n".join([*lines, f"Take x and P as {given}: the run begins with them."])
    if found.textbook:
        return (
            "These are an EKF's numbers, with the equations of motion and sensor as they are "
            f"handed out; {sides.reference} is another filter here. Nothing is guessed."
        )
    if not found.guesses:
        none = "No known mistake, alone or with another, gives these numbers."
        return none + _singular(found.first.step) + _coarse(found.first.step, sides)
    best, *others = found.guesses
    lines = [f"Guess: {_told(best, sides)}"]
    lines += [f"Or: {_told(other, sides)}" for other in others[: MOST_ALIKE - 1]]
    return "\n".join(lines)


def _told(guess: Guess, sides: Sides) -> str:
    """A guess: what was done, and what to read again."""
    done = "; and ".join(_words(mistake.told, sides) for mistake in guess)
    return f"{done}. Read again: {'; '.join(_words(mistake.read, sides) for mistake in guess)}."


def _each(found: Found, sides: Sides) -> Iterator[str]:
    """Every mistake that shows, with the steps at which it does; those that have no name, too."""
    in_guess = {mistake for guess in found.guesses[:1] for mistake in guess}
    for mistake, seen in found.named.items():
        names = [mistake.name] + [
            guess[0].name for guess in found.guesses[1:] if found.guesses[0] == (mistake,)
        ]
        yield _shows(found, " or ".join(names[:MOST_ALIKE]), seen) + (
            "." if mistake in in_guess else f": {_told((mistake,), sides)}"
        )
    for seen in found.unnamed:
        what = "moves" if isinstance(seen.first.step.asked.given, Control) else "readings"
        unknown = "" if found.textbook else " that no known mistake gives"
        yield _shows(found, f"A difference of {what}{unknown}", seen) + "."


def _shows(found: Found, what: str, seen: Seen) -> str:
    if seen.steps == 1:
        return f"{what} shows at {_where(found, seen.first)}"
    return f"{what} shows at {seen.steps} steps, first at {_where(found, seen.first)}"


def _singular(step: Compared) -> str:
    """A warning where P has no inverse, for readings alone."""
    asked = step.asked
    if isinstance(asked.given, Control):
        return ""
    _, rank, _ = squared_mahalanobis(np.zeros(len(asked.x)), asked.P)
    if int(rank) == len(asked.x):
        return ""
    return f" (P has rank {int(rank)} of {len(asked.x)} here: a form that inverts it fails.)"


def _coarse(step: Compared, sides: Sides) -> str:
    """What is odd in the digits of an answer: float32, or decimals that were cut off."""
    if sides.printed:
        return ""
    for name, values in (("x", step.theirs.x), ("P", step.theirs.P)):
        if (values == np.round(values)).all():
            continue  # whole numbers say nothing
        if (values == values.astype(np.float32)).all():
            return f" All numbers of {name} are float32: they have 7 digits."
        for decimals in range(1, MOST_DECIMALS):
            if (values == np.round(values, decimals)).all():
                return f" All numbers of {name} are rounded to {decimals} decimals."
    return ""


def _where(found: Found, at: At) -> str:
    """A step, with its run where there are several."""
    return at.step.asked.step if found.runs == 1 else f"{at.step.asked.step} of run {at.run}"


def _words(text: str, sides: Sides) -> str:
    return text if sides.classroom else elsewhere(text)


def _size(one: Difference) -> str:
    return f"{one.size:.2g} σ{'²' if one.entry.startswith('P_') else ''}"


def _row(values: Array) -> str:
    return f"[{', '.join(f'{value:.6g}' for value in values.tolist())}]"


def _matrix(P: Array) -> str:
    """P, a line for each row, as Python writes it."""
    rows = [_row(np.array(row)) for row in cleared(P, ROUNDING)]
    between = ",\n       "
    return f"  P = [{between.join(rows)}]\n"
