"""The two sides of a comparison, as a scene names them: who is called, beside which reference."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ekfsim.errors import UsageError
from ekfsim.filters import FILTERS
from ekfsim.filters.place import is_place, label
from ekfsim.filters.tuning import CROWDS
from ekfsim.localization import entries_of, filter_of, first_belief
from ekfsim.scene import Scene
from ekfsim.student.asked import Caller
from ekfsim.student.comparing.compare import Compared, compare
from ekfsim.student.comparing.reference import Around
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.loading import load

# a filter that goes on from any mean and covariance, and does the same again
COMPARABLE = tuple(
    name for name in FILTERS if name not in ("kf-nominal", "adaptive", "mhekf", *CROWDS)
)


def caller_of(scene: Scene, provided: Sequence[str] | None = None) -> Caller:
    """Who calls the filter that the scene names.

    provided : which equations of the models its code may ask for; None: all
    Raises UsageError where there is no such filter, FaultError where its code fails.
    """
    if is_place(scene.filter):
        code = load(scene.filter)
        if not isinstance(code.form, Whole):
            return InProcess(code, provided)
    return Around(filter_of(scene), label(scene.filter))


def runs_of(
    scene: Scene, caller: Caller, against: str, runs: int = 1
) -> Iterator[tuple[int, Iterator[Compared]]]:
    """The steps of as many runs from the scene's own on, each with its number, under whoever is
    called and beside the filter of that name or place.
    """
    for run in range(scene.run, scene.run + runs):
        one = replace(scene, run=run, filter=against, beside=())
        first, reference, layout = first_belief(one), filter_of(one), one.world.layout
        yield run, compare(entries_of(one), first, caller, reference, layout, one.guard)


def comparable(name: str, option: str) -> str:
    """The same name. Raises UsageError where the filter is none that can be compared."""
    if name in FILTERS and name not in COMPARABLE:
        known = ", ".join(COMPARABLE)
        raise UsageError(
            f"{option} {name}: does not go on from a mean and a covariance alone; "
            f"known: {known}, or one of your own: FILE.py"
        )
    return name
