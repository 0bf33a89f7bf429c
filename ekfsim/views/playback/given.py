"""Steps as somebody hands them in."""

from collections.abc import Iterable, Iterator

from ekfsim.errors import UsageError
from ekfsim.records import Step


def steps_in(given: Iterable[Step]) -> Iterator[Step]:
    """Each of the steps. Raises UsageError for what holds none, as a scene that is not played."""
    for step in given if isinstance(given, Iterable) else [given]:
        if not isinstance(step, Step):
            raise UsageError(
                f"{type(given).__name__!r} holds no steps; give those of a run, as "
                "ekfsim.play(scene) makes them"
            )
        yield step
