"""What can be said of a filter after many runs, in two parts: how they ended, and what happened on
the way.

At the end there are shares of runs, each with its 95 % interval (Wilson): one that reaches over the
edge between two words decides nothing, and the filter only leans. A run that happens to end well is
no clean bill: on the way the readings tell (NIS), and the steps at which too many runs are lost.
"""

import math
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

from ekfsim.study.results import AtStep, Mean, Result, Share, Z

MEDIAN = 0.45, 0.55  # right: the share of runs above the median of χ²
COVERED = 0.934, 0.974  # the share inside their ellipse of 95.4 %
MOST_LOST = 0.02
NIS = 0.8, 1.25  # per number read
ONE_SIDED = 0.025
FEWEST = 100  # runs of which shares in percent can be told at all


class Word(Enum):
    """The verdict on a filter. The value is the word."""

    CONSISTENT = "consistent"
    OVER_CONFIDENT = "over-confident"
    OVER_CAUTIOUS = "over-cautious"
    NO_EVIDENCE = "no evidence"


@dataclass(frozen=True)
class Measure:
    """A share of runs at the end, the range in which it is right, and what it says of the filter
    outside of it.
    """

    share: Share
    low: float
    high: float
    below: Word
    above: Word

    def word_of(self, value: float) -> Word:
        """What a value of the share says. On an edge it is right."""
        if value > self.high:
            return self.above
        return self.below if value < self.low else Word.CONSISTENT

    @property
    def word(self) -> Word:
        """What it says."""
        return self.word_of(self.share.value)

    @property
    def decided(self) -> bool:
        """Whether all of its interval says the same."""
        return self.word_of(self.share.low) is self.word_of(self.share.high) is self.word

    @property
    def runs_to_tell(self) -> float:
        """Of how many runs its interval would no longer reach over an edge, were the share the
        same; inf on the edge.

        The interval of the share p of n runs ends at e where (p − e)² = z² e (1 − e) / n.
        """
        p = self.share.value
        edges = [e for e in (self.low, self.high) if e > 0]
        if self.word is not Word.CONSISTENT:
            edges = [min(edges, key=lambda e: abs(p - e))]
        return max(Z * Z * e * (1 - e) / (p - e) ** 2 if p != e else math.inf for e in edges)


@dataclass(frozen=True)
class AtEnd:
    """How the runs ended."""

    runs: int
    above_median: Measure
    covered: Measure
    lost: Measure

    @classmethod
    def of(cls, last: AtStep) -> "AtEnd":
        """The measures of the last step. More above the median, fewer inside, more lost:
        over-confident.
        """
        confident, cautious = Word.OVER_CONFIDENT, Word.OVER_CAUTIOUS
        return cls(
            last.runs,
            Measure(last.above_50, *MEDIAN, cautious, confident),
            Measure(last.ellipse, *COVERED, confident, cautious),
            Measure(last.lost, 0.0, math.nextafter(MOST_LOST, 0.0), confident, confident),
        )

    @property
    def measures(self) -> tuple[Measure, ...]:
        """Those that say something: where no run's ellipse has an area, there is no coverage."""
        return tuple(m for m in (self.above_median, self.covered, self.lost) if m.share.of)

    @property
    def word(self) -> Word:
        """Consistent where all three are right. Of two faults over-confidence is told: it is the
        one that loses robots.

        Where no run is uncertain of anything there is nothing that could be right.
        """
        if not self.above_median.share.of:
            return Word.NO_EVIDENCE
        words = {measure.word for measure in self.measures}
        return next(
            w for w in (Word.OVER_CONFIDENT, Word.OVER_CAUTIOUS, Word.CONSISTENT) if w in words
        )

    @property
    def decided(self) -> bool:
        """Whether the intervals leave no doubt: of all measures that it is right, or of one that it
        is not.
        """
        if self.word is Word.NO_EVIDENCE:
            return False
        enough = all if self.word is Word.CONSISTENT else any
        return enough(measure.decided for measure in self.measures if measure.word is self.word)

    @property
    def runs_to_tell(self) -> float:
        """How many runs would decide, were all shares what they are of these; inf where one lies on
        its edge.
        """
        enough = max if self.word is Word.CONSISTENT else min
        siding = [measure for measure in self.measures if measure.word is self.word]
        return max(
            enough(measure.runs_to_tell * self.runs / measure.share.of for measure in siding),
            FEWEST,
        )


@dataclass(frozen=True)
class OnTheWay:
    """What happened on the way: NIS of all readings, and the steps at which too many runs were
    lost.
    """

    nis: Mean  # per number read
    # where the interval of the share beyond the χ² 99.9 % quantile lies above 2 %
    steps: tuple[AtStep, ...]
    judged: int  # steps that were looked at

    @classmethod
    def of(cls, result: Result) -> "OnTheWay":
        """Of all judged steps, the start among them."""
        lost = tuple(at for at in result.steps if at.above_999.low > MOST_LOST)
        return cls(result.nis, lost, len(result.steps))

    @property
    def word(self) -> Word | None:
        """Over-confident, over-cautious, or None: nothing is said."""
        low, high = NIS
        if self.steps or self.nis.value > high:
            return Word.OVER_CONFIDENT
        return Word.OVER_CAUTIOUS if self.nis.value < low else None

    @property
    def decided(self) -> bool:
        """Whether it is more than chance: NIS lies outside its band, or a step stands out from all
        that were looked at.

        Among a thousand steps one of a few runs lies beyond 99.9 % sooner or later. So as many must
        lie there that, were it 2 % of all runs, chance would put them there at one of all steps in
        one study of forty (Bonferroni).
        """
        from scipy.special import bdtrc  # takes a fifth of a second to import

        low, high = NIS
        if self.nis.value > max(high, self.nis.high) or self.nis.value < min(low, self.nis.low):
            return True
        shares = (at.above_999 for at in self.steps)
        return any(
            self.judged * bdtrc(share.runs - 1, share.of, MOST_LOST) < ONE_SIDED for share in shares
        )

    @property
    def worst(self) -> AtStep:
        """The step at which the largest share was beyond."""
        return max(self.steps, key=lambda at: at.above_999.value)


@dataclass(frozen=True)
class Verdict:
    """The verdict on a filter."""

    result: Result

    @cached_property
    def at_end(self) -> AtEnd:
        """How the runs ended."""
        return AtEnd.of(self.result.last)

    @cached_property
    def on_the_way(self) -> OnTheWay:
        """What happened before."""
        return OnTheWay.of(self.result)
