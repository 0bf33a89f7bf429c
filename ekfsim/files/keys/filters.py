"""The keys of a filter: its name, or its place, and the numbers that it alone has."""

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from ekfsim.files.keys.fields import (
    Late,
    Strict,
)
from ekfsim.filters.tuning import (
    MOST_HYPOTHESES,
    MOST_PARTICLES,
    CrossCovariances,
    RangeVariance,
    Tuning,
)

if TYPE_CHECKING:
    from ekfsim.files.keys.drive import WayKeys
else:
    WayKeys = Annotated[Any, Late("ekfsim.files.keys.drive:WayKeys")]


# of a filter, in a schema: FILE.py, FILE.py:Name or package.module:Name
PLACE = r"^(.*\.py(:\w*)?|[^\W\d][\w.]*:[^\W\d][\w.]*)$"


def filter_names() -> list[str]:
    """The filters there are: built-in ones, and those that installed packages register."""
    from ekfsim.filters import FILTERS
    from ekfsim.filters.choice import registered

    return [*FILTERS, *registered()]


def known_filters(schema: dict[str, Any]) -> None:
    """Let the schema list the filters, and say how a place of another is written."""
    schema["anyOf"] = [{"enum": filter_names()}, {"pattern": PLACE}, {"pattern": "-smoothed$"}]


def is_filter(name: str) -> bool:
    """Whether it names a filter, or a place where one may be found."""
    from ekfsim.filters import FILTERS
    from ekfsim.filters.place import forward, is_place

    alone = forward(name)
    return alone in FILTERS or is_place(name) or alone in filter_names()


class TuningKeys(Strict):
    """Numbers that a filter alone has."""

    particles: int | None = Field(
        Tuning.particles,
        description="Particles of each run, of the pf; 1000 where absent. Of the amcl at most so "
        "many; 5000 where absent.",
        ge=1,
        le=MOST_PARTICLES,
        examples=[10000],
    )
    alpha: float = Field(
        Tuning.alpha,
        description="How far the ukf's sigma points lie from the mean: √(alpha² (n + kappa)) "
        "standard deviations.",
        gt=0,
        le=1000,
        examples=[0.5],
    )
    beta: float = Field(
        Tuning.beta,
        description="What the ukf knows of the shape: 2 for a Gaussian, where alpha is small.",
        ge=0,
        le=1000,
        examples=[2],
    )
    kappa: float | None = Field(
        Tuning.kappa,
        description="Of the ukf's sigma points, more than −n for a state of n numbers; max(3 − n, "
        "0) where absent.",
        ge=-1000,
        le=1000,
        examples=[1],
    )
    iterations: int = Field(
        Tuning.iterations,
        description="How many steps the iekf's search takes at most, half a step counting as "
        "half; 0 makes it the ekf.",
        ge=0,
        le=1000,
        examples=[20],
    )
    hypotheses: int = Field(
        Tuning.hypotheses,
        description="Gaussians of the mhekf at most; beyond them the lightest are left out.",
        ge=1,
        le=MOST_HYPOTHESES,
        examples=[4],
    )
    huber: float = Field(
        Tuning.huber,
        description="Standard deviations of an innovation beyond which a reading pulls the huber "
        "filter no harder than it does there.",
        gt=0,
        le=8,
        examples=[3],
    )
    adaptive: float = Field(
        Tuning.adaptive,
        description="How much of what the adaptive filter has learnt of a sensor's noise a reading "
        "leaves: 0.9 remembers about ten readings; 1 makes it the ekf.",
        gt=0,
        le=1,
        examples=[0.95],
    )
    clutter: float = Field(
        Tuning.clutter,
        description="Share of readings that the pdaf takes for something else than it expected; 0 "
        "makes it the ekf.",
        ge=0,
        lt=1,
        examples=[0.02],
    )
    clutter_density: float = Field(
        Tuning.clutter_density,
        alias="clutterDensity",
        description="How dense such readings lie, per m or rad of each number: 0.1 where they may "
        "be anywhere in 10 m. Of the pdaf.",
        gt=0,
        le=1000,
        examples=[0.25],
    )
    range_variance: RangeVariance = Field(
        Tuning.range_variance,
        alias="rangeVariance",
        description="Whence the classroom's C_v = (ratio · r)² takes its r: the prediction, or (a "
        "counter-example) the reading.",
        examples=["reading"],
    )
    cross_covariances: CrossCovariances = Field(
        Tuning.cross_covariances,
        alias="crossCovariances",
        description="Whether σ_xθ and σ_yθ are kept in the classroom's P, or (a counter-example) "
        "dropped after every step. Not of the pf, which has no P.",
        examples=["dropped"],
    )
