"""What can be said of a filter after many runs: the rule, and from which step on it holds."""

import math
from dataclasses import dataclass
from enum import Enum

from ekfsim.study.counting import COVERAGE
from ekfsim.study.results import AtStep, Result, Share

MEDIAN, MEDIAN_WITHIN = 0.5, 0.05  # the share of runs above the median of χ²
COVERAGE_WITHIN = 0.02
MOST_LOST = 0.02


class Word(Enum):
    """The verdict on a filter. The value is the word."""

    CONSISTENT = "consistent"
    OVER_CONFIDENT = "over-confident"
    OVER_CAUTIOUS = "over-cautious"
    NO_EVIDENCE = "no evidence"


@dataclass(frozen=True)
class Verdict:
    """The verdict on a filter, and the step from which on to the end it is not consistent."""

    word: Word
    since: AtStep | None = None


def word_at(at: AtStep) -> Word:
    """The verdict on one step.

    Consistent where the share of runs above the median of χ² lies within 0.5 ± 0.05, the coverage within 0.954 ± 0.02
    (its interval allowed for), and fewer than 2 % are lost. What is over-confident in one is not over-cautious.
    """
    if at.above_50.of == 0:
        return Word.NO_EVIDENCE
    if at.lost.value >= MOST_LOST:
        return Word.OVER_CONFIDENT
    if not agrees(at.above_50):
        return Word.OVER_CONFIDENT if at.above_50.value > MEDIAN else Word.OVER_CAUTIOUS
    if not covers(at.ellipse):
        return Word.OVER_CONFIDENT if at.ellipse.value < COVERAGE else Word.OVER_CAUTIOUS
    return Word.CONSISTENT


def agrees(above: Share) -> bool:
    """Whether as many runs lie above the median as there should."""
    return MEDIAN - MEDIAN_WITHIN <= above.value <= MEDIAN + MEDIAN_WITHIN


def covers(inside: Share) -> bool:
    """Whether as many runs lie inside as there should, the interval allowed for; also where none has an ellipse."""
    return math.isnan(inside.value) or (
        inside.low <= COVERAGE + COVERAGE_WITHIN and inside.high >= COVERAGE - COVERAGE_WITHIN
    )


def proven(at: AtStep) -> bool:
    """Whether there are runs enough: what is not consistent stays so anywhere in its interval.

    What is consistent has an interval no wider than the range in which it is: some 400 runs.
    """
    low, high = MEDIAN - MEDIAN_WITHIN, MEDIAN + MEDIAN_WITHIN
    if word_at(at) is Word.CONSISTENT:
        return at.above_50.high - at.above_50.low <= high - low
    apart = not agrees(at.above_50) and (at.above_50.low > high or at.above_50.high < low)
    return apart or not covers(at.ellipse) or at.lost.low >= MOST_LOST


def verdict(result: Result) -> Verdict:
    """The verdict on the last step, and the first step from which on it holds without a gap."""
    word = word_at(result.last)
    if word in (Word.CONSISTENT, Word.NO_EVIDENCE):
        return Verdict(word)
    since = result.last
    for at in reversed(result.steps):
        if word_at(at) is not word:
            break
        since = at
    return Verdict(word, since)
