"""The log of a driven robot, many ticks at once."""

from collections.abc import Iterator
from itertools import repeat

from ekfsim.fast.records import records
from ekfsim.records import Control, Entry
from ekfsim.simulation.driven import Happened


def written(happened: Happened, index: int) -> Iterator[Entry]:
    """The entries of what happened in T ticks, numbered from index + 1."""
    told, u, truth, t, readings, fixes = happened
    numbers, n = [], len(t)
    for read in readings:
        numbers.append(index := index + 1)
        index += len(read)
    nothing, stamps = repeat(None), t.tolist()
    controls = records(
        Entry, n, numbers, records(Control, n, repeat(told), u), truth, nothing, nothing, stamps,
        repeat(True), nothing if fixes is None else fixes,
    )  # fmt: skip
    begun = 0
    for i in [i for i, read in enumerate(readings) if read]:
        yield from controls[begun : i + 1]
        begun = i + 1
        for k, reading in enumerate(readings[i], start=1):
            yield Entry(numbers[i] + k, reading, truth[i], t=stamps[i])
    yield from controls[begun:]
