"""Steps on their way to what is shown, and to whoever wants them all."""

from collections.abc import Callable, Iterable, Iterator, Sequence

from ekfsim.errors import StepError
from ekfsim.records import Step


def kept(steps: Iterable[Step], takers: Sequence[Callable[[Step], None]]) -> Iterator[Step]:
    """The same steps, each handed to every taker before it goes on:
    what is shown may leave some out.
    """
    for step in steps:
        for take in takers:
            take(step)
        yield step


def heard(steps: Iterable[Step], hear: Callable[[int], None]) -> Iterator[Step]:
    """The same steps, each with a word on its index as soon as it is made: what was printed till
    then belongs to it. What is printed by a step that fails belongs to the last one.
    """
    index = 0
    try:
        for step in steps:
            index = step.entry.index
            hear(index)
            yield step
    except StepError:
        hear(index)
        raise


def nobody(step: int) -> None:
    """Hears nothing, where what is printed is not shown beside the steps."""
