"""What twins are tried on: for each function of the text, arguments as they come and as they hardly
ever do.

A function marked `@inputs(of)` stands for one row's text, or for several of one kind. It is given a
generator and how many runs there are side by side, None for one robot; it yields tuples of
arguments, as many as it likes.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

RUNS = (None, 1, 63, 64, 1024)  # one robot, and on either side of what is called many


@dataclass(frozen=True)
class Inputs:
    """Where arguments come from, and how near twin and text must be."""

    make: Callable[[np.random.Generator, int | None], Iterator[tuple[Any, ...]]]
    within: float  # of the largest number of the same run
    filled: bool  # whether the first argument is there to be changed


INPUTS: dict[tuple[str, str], Inputs] = {}


def inputs(of, given="", within=1e-12, filled=False):
    """Mark what makes arguments for the text `of`; `given` is the class of the first argument,
    where the row has one.

    within : wider than 1e-12 only where the text itself has no more digits; say why
    filled : the first argument takes what the others bring, and must be the same afterwards
    """

    def mark(make):
        assert (of, given) not in INPUTS, f"{of} {given} has inputs already"
        INPUTS[of, given] = Inputs(make, within, filled)
        return make

    return mark


def axes_of(runs):
    """The leading axes (…) of so many runs."""
    return () if runs is None else (runs,)
