"""What is left of many runs when they are over: a record that adds to others, and whose size knows
no runs.

Addition is associative (sums of floating numbers but for their last digits), and `Tally.empty` adds
nothing.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from ekfsim.geometry import Array, Integers


class AtSteps(NamedTuple):
    """Counts and sums over runs, for each of k steps : (k,) each; of one step : ()"""

    judged: Integers  # runs of which the NEES says something: some freedom, or an impossible belief
    impossible: Integers
    # runs whose NEES lies above the 50 % quantile of χ², impossible ones included
    above_50: Integers
    above_95: Integers
    above_999: Integers
    in_ellipse: Integers
    ellipse_runs: Integers  # runs whose ellipse is one
    in_cone: Integers
    cone_runs: Integers  # runs that are not certain of their heading
    nees_runs: Integers  # judged and not impossible
    nees_dof: Integers
    nees_sum: Array
    position_square: Array  # Σ (ex² + ey²) m²
    heading_square: Array  # Σ eθ² rad²


def dtype_of(field: str) -> type[np.float64] | type[np.int64]:
    """Whether a column of AtSteps holds sums or counts."""
    return np.float64 if field.endswith(("sum", "square")) else np.int64


class OfRuns(NamedTuple):
    """Counts and sums over runs that are over."""

    nis_runs: int = 0  # runs that had a NIS at all
    nis_above: int = 0  # ΣNIS of the run above its two-sided 95 % band
    nis_below: int = 0
    nis_readings: int = 0
    nis_dof: int = 0
    nis_sum: float = 0.0
    nees_above: int = 0  # the last NEES above its two-sided 95 % bounds, or impossible
    nees_below: int = 0
    unsettled: int = 0  # readings at which the search of an iterated filter was cut off


class Extreme(NamedTuple):
    """The run that ended worst: an impossible belief, else the largest last NEES; of equals the
    lowest number.
    """

    impossible: bool = False
    nees: float = -1.0  # of no run at all; of a run it is 0 or more
    run: int = 0

    @property
    def rank(self) -> tuple[bool, float, int]:
        """Greater is worse."""
        return self.impossible, self.nees, -self.run


class Bin(NamedTuple):
    """Runs whose last NEES is nearly the same."""

    runs: int  # how many
    lowest: int  # the lowest number among them


@dataclass(frozen=True, eq=False, kw_only=True)
class Tally:
    """What a study keeps of its runs."""

    runs: int
    steps: Integers  # (k,) which steps are told of
    times: Array  # (k,) s; nan where there is no clock
    at: AtSteps
    of: OfRuns
    lost_from: Mapping[int, int]  # runs by the step from which on they are lost without a gap
    spread: Mapping[int, Bin]  # runs by the logarithm of their last NEES
    worst: Extreme

    @classmethod
    def empty(cls, steps: Integers) -> Self:
        """The tally of no runs, with these steps to be told of."""
        none = (np.zeros(steps.shape, dtype_of(name)) for name in AtSteps._fields)
        return cls(
            runs=0,
            steps=steps,
            times=np.full(steps.shape, np.nan),
            at=AtSteps._make(none),
            of=OfRuns(),
            lost_from={},
            spread={},
            worst=Extreme(),
        )

    def __add__(self, other: "Tally") -> "Tally":
        """The tally of the runs of both, of which the same steps are told."""
        return Tally(
            runs=self.runs + other.runs,
            steps=self.steps,
            times=np.fmax(self.times, other.times),  # the same, where either has a clock
            at=AtSteps._make(map(np.add, self.at, other.at)),
            of=OfRuns._make(one + another for one, another in zip(self.of, other.of, strict=True)),
            lost_from=Counter(self.lost_from) + Counter(other.lost_from),
            spread=together(self.spread, other.spread),
            worst=max(self.worst, other.worst, key=lambda extreme: extreme.rank),
        )

    def plain(self) -> dict[str, Any]:
        """Lists and numbers, fit for JSON, from which `of_plain` makes the same tally to the last
        bit.
        """
        return {
            "runs": self.runs,
            "steps": self.steps.tolist(),
            "times": self.times.tolist(),
            "at": {name: column.tolist() for name, column in self.at._asdict().items()},
            "of": self.of._asdict(),
            "lost_from": sorted(self.lost_from.items()),
            "spread": sorted((key, *held) for key, held in self.spread.items()),
            "worst": self.worst._asdict(),
        }

    @classmethod
    def of_plain(cls, plain: Mapping[str, Any]) -> Self:
        """The tally that `plain` came from."""
        columns = (np.array(plain["at"][name], dtype_of(name)) for name in AtSteps._fields)
        return cls(
            runs=plain["runs"],
            steps=np.array(plain["steps"], np.int64),
            times=np.array(plain["times"], np.float64),
            at=AtSteps._make(columns),
            of=OfRuns(**plain["of"]),
            lost_from=dict(plain["lost_from"]),
            spread={key: Bin(runs, lowest) for key, runs, lowest in plain["spread"]},
            worst=Extreme(**plain["worst"]),
        )


def together(one: Mapping[int, Bin], other: Mapping[int, Bin]) -> dict[int, Bin]:
    """The runs of both, bin by bin."""
    both = dict(one)
    for key, (runs, lowest) in other.items():
        held = both.get(key, Bin(0, lowest))
        both[key] = Bin(held.runs + runs, min(held.lowest, lowest))
    return both
