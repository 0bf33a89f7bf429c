"""Steps → the columns of `run --csv`, as a DataFrame where pandas is there."""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib.util import find_spec
from typing import Any

import numpy as np

from ekfsim.diagnostics.unplaced import Unplaced
from ekfsim.errors import UsageError
from ekfsim.files.results.trajectories import columns_of, row_of
from ekfsim.geometry import Array
from ekfsim.printable import in_a_line
from ekfsim.records import Step
from ekfsim.views.playback.given import steps_in
from ekfsim.views.words.text_table import aligned

TEXTS = ("type", "sensor", "refused")  # columns of words, even where all of them are empty
SHOWN = 10  # rows of a table that is longer: its first and its last


class Columns(dict[str, "Array"]):
    """A table where pandas is not: an array for each column, by its name."""

    def __repr__(self) -> str:
        """The first and the last rows."""
        return "\n".join([*aligned([list(self), *self._rows()], 0), self._size])

    def _repr_html_(self) -> str:
        """The same as a table of a page."""
        heads = "".join(f"<th>{escape(name)}</th>" for name in self)
        cells = ("".join(f"<td>{escape(value)}</td>" for value in row) for row in self._rows())
        rows = "".join(f"<tr>{row}</tr>" for row in cells)
        return f"<table><tr>{heads}</tr>{rows}</table><p>{self._size}</p>"

    @property
    def _size(self) -> str:
        return f"{self._length} rows × {len(self)} columns"

    @property
    def _length(self) -> int:
        return len(next(iter(self.values()), ()))

    def _rows(self) -> Iterable[list[str]]:
        n = self._length
        half = SHOWN // 2
        for k in range(n):
            if n <= SHOWN or k < half or k >= n - half:
                yield [in_a_line(_shown(column[k])) for column in self.values()]
            elif k == half:
                yield ["…"] * len(self)


def table(steps: Iterable[Step], confidence: float = 0.954) -> Any:
    """What became of each step, in the columns that `run --csv` writes, with the same numbers: a
    pandas DataFrame where pandas is installed, else a dict of arrays.

    m, rad and their squares; nan where a number is undefined. confidence : of the ellipse.
    Raises UsageError for what holds no steps, and for those of many runs side by side.
    """
    known = list(steps_in(steps))
    if any(step.posterior.mean.ndim > 1 for step in known):
        raise UsageError("a table is of one run: these steps hold many side by side")
    commanded = all(step.entry.t is None for step in known)
    unplaced = Unplaced(known[0].posterior, known[0].layout) if known else None
    rows = [
        row_of(step, commanded, confidence, unplaced is not None and unplaced.at(step.posterior))
        for step in known
    ]
    names = columns_of(commanded)
    columns = zip(*rows, strict=True) if rows else [()] * len(names)
    return framed(dict(zip(names, columns, strict=True)))


def framed(columns: Mapping[str, Sequence[Any]]) -> Any:
    """Columns of numbers and texts, "" where a number is undefined: a DataFrame where pandas is
    installed, else Columns.
    """
    found = Columns((name, _array(values, name in TEXTS)) for name, values in columns.items())
    if find_spec("pandas") is None:
        return found
    from pandas import DataFrame

    return DataFrame(found)


def _array(values: Iterable[Any], is_text: bool) -> Any:
    """Texts, whole numbers, or numbers."""
    told = list(values)
    if is_text or any(isinstance(value, str) and value for value in told):
        return np.array(told, dtype=object)
    if all(isinstance(value, int) for value in told):
        return np.array(told, dtype=np.int64)
    return np.array([np.nan if value == "" else value for value in told], dtype=float)


def _shown(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
