"""The two sides of a comparison, as a scene names them: who is called, beside which reference."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ekfsim.errors import UsageError
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.place import is_place, label
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Array
from ekfsim.localization import filter_of, first_belief
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.student.asked import Answer, Asked, Caller
from ekfsim.student.comparing.compare import Compared, compare
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.loading import load
from ekfsim.systems import system_of

# a filter that goes on from any mean and covariance, and does the same again
COMPARABLE = tuple(name for name in FILTERS if name not in ("kf-nominal", "pf"))


@dataclass(frozen=True)
class Around:
    """Calls a filter of the full protocol as it calls two functions."""

    filter: Filter
    label: str

    def begin(self, x: Array, P: Array) -> None:
        """It keeps nothing."""

    def call(self, asked: Asked) -> Answer:
        """The belief that the filter makes of it."""
        prior = Gaussian(asked.x, asked.P)
        match asked.given:
            case Control(motion, u):
                after, _ = self.filter.predict(prior, motion, u)
            case Reading(sensor, z):
                after, _ = self.filter.update(prior, sensor, z)
        return Answer(*after)

    def place_of(self, given: Control | Reading) -> str:
        """What people see of the filter."""
        return self.label


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
        happened = simulate(one) if one.log is None else one.log.entries
        entries = system_of(one.world.system).entries(happened, one.reading)
        yield (
            run,
            compare(
                entries, first_belief(one), caller, filter_of(one), one.world.layout, one.guard
            ),
        )


def comparable(name: str, option: str) -> str:
    """The same name. Raises UsageError where the filter is none that can be compared."""
    if name in FILTERS and name not in COMPARABLE:
        known = ", ".join(COMPARABLE)
        raise UsageError(
            f"{option} {name}: does not go on from a mean and a covariance alone; "
            f"known: {known}, or one of your own: FILE.py"
        )
    return name
