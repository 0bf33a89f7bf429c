"""A fix at every row of the wheels, interpolated: what the authors of document 003 give to their filter."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ekfsim.geometry import Array
from ekfsim.records import Control, Entry, Reading


def interpolated(entries: Iterable[Entry]) -> Iterator[Entry]:
    """The same log with a reading after each motion input, on the straight line between the recorded ones.

    Before the first reading that one is held, after the last one that. No filter at work could do so: at every instant
    it would have to know the next fix already. A row of the wheels that a fix cut in two counts as two.
    """
    log = list(entries)
    given = [entry.given for entry in log if isinstance(entry.given, Reading)]
    times = np.array([entry.t for entry in log if isinstance(entry.given, Reading)], np.float64)  # (k,) s
    fixes, index = [reading.z for reading in given], 0
    for entry in log:
        if isinstance(entry.given, Reading):
            continue
        yield replace(entry, index=index)
        index += 1
        if given and isinstance(entry.given, Control) and entry.t is not None:
            z = _at(entry.t, times, fixes)
            yield replace(entry, index=index, given=replace(given[0], z=z))
            index += 1


def _at(t: float, times: Array, fixes: list[Array]) -> Array:
    """The fix at an instant : (…, 2)"""
    after = int(np.searchsorted(times, t))
    one, other = max(after - 1, 0), min(after, len(times) - 1)
    span = times[other] - times[one]
    share = (t - times[one]) / span if span > 0 else 0.0
    return np.asarray(fixes[one] + share * (fixes[other] - fixes[one]), np.float64)
