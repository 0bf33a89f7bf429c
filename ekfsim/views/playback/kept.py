"""Steps on their way to what is shown, and to whoever wants them all."""

from collections.abc import Callable, Iterable, Iterator, Sequence

from ekfsim.records import Step


def kept(steps: Iterable[Step], takers: Sequence[Callable[[Step], None]]) -> Iterator[Step]:
    """The same steps, each handed to every taker before it goes on:
    what is shown may leave some out.
    """
    for step in steps:
        for take in takers:
            take(step)
        yield step
