"""What is found in a narrative that another program printed, in words."""

import math
from collections.abc import Iterator, Sequence

from ekfsim.student.printed.narrative.found import NarrativeFound
from ekfsim.student.printed.narrative.numbers import Wrong
from ekfsim.views.student.telling import apart, filled
from ekfsim.views.words.numbers import count

MOST = 40  # wrong numbers that are told; of more only how many


def told(found: NarrativeFound, made: str) -> str:
    """All that is found; every line ends in a newline.

    made : what makes the run again that it was held against
    """
    parts = [_headline(found), *found.remarks]
    if found.wrong:
        first, *others = found.wrong
        parts.append(f"First, {_sentence(first)}{_why(first)}")
        parts += _others(first, others)
    return "\n".join(f"{filled(part)}\n" for part in [*parts, made])


def _headline(found: NarrativeFound) -> str:
    steps = count(found.steps, "step")
    if not found.wrong:
        return (
            f"{found.file} is right: all {found.checked} numbers of {steps} that can be "
            "calculated from those before them are these, as far as its digits go."
        )
    if found.checked < len(found.wrong):  # what cannot be read was not calculated
        return f"{found.file} is wrong in {count(len(found.wrong), 'place')}."
    return (
        f"{found.file} is wrong in {len(found.wrong)} of the {found.checked} numbers of {steps} "
        "that can be calculated from those before them."
    )


def _others(first: Wrong, others: Sequence[Wrong]) -> Iterator[str]:
    """The other wrong numbers; those with one explanation together."""
    alike = dict[tuple[str, str], list[Wrong]]()
    for one in others:
        key = ("", one.guess) if one.guess else (one.what, str(one.line))
        alike.setdefault(key, []).append(one)
    lines = list[str]()
    for ones in alike.values():
        one, more = ones[0], len(ones) - 1
        known = one.guess == first.guess and bool(one.guess)
        so = f" So {'is' if more == 1 else 'are'} {more} more." if more else ""
        lines.append(f"L{_sentence(one)[1:]}{' (the same)' * known or _why(one)}{so}")
    if lines:
        yield "\n".join(lines[:MOST])
    if len(lines) > MOST:
        yield f"And {len(lines) - MOST} more."


def _sentence(one: Wrong) -> str:
    if math.isnan(one.right):
        return f"line {one.line}: {one.what} is {one.theirs:g}, and no number."
    theirs, right = apart(one.theirs, one.right)
    unit = f" {one.unit}" if one.unit else ""
    bound = f" {one.bound}" if one.bound else ""
    return f"line {one.line}: {one.what} is {theirs}{unit}, right is{bound} {right}{unit}."


def _why(one: Wrong) -> str:
    guess = f" Guess: {one.guess}." if one.guess else ""
    return guess + (f" Read again: {one.read}." if one.read else "")
