"""Which runs Numba compiles from their draws to what is counted, and what is said of the others."""

from collections.abc import Iterable

from ekfsim.filters.place import label
from ekfsim.scene import Scene

FILTERS = "ekf", "huber", "pdaf"


def is_whole(scene: Scene) -> bool:
    """Whether its runs are: of such a filter as it comes, without probes, in the classroom."""
    return scene.filter in FILTERS and _not_so(scene) is None


def by_parts(scenes: Iterable[Scene]) -> list[str]:
    """A line that names those of these scenes whose runs are not; none where all are."""
    named = dict.fromkeys(_named(scene) for scene in scenes if not is_whole(scene))
    if not named:
        return []
    whole = ", ".join(FILTERS)
    return [
        f"--fast compiles whole runs of {whole} in the classroom; of {', '.join(named)} only "
        f"beams and matrices, which gains less"
    ]


def _named(scene: Scene) -> str:
    """The filter of a scene, with what keeps it from being compiled whole, where that is no matter
    of the filter.
    """
    name, reason = label(scene.filter), _not_so(scene)
    return f"{name} {reason}" if scene.filter in FILTERS and reason else name


def _not_so(scene: Scene) -> str | None:
    """What of a scene, its filter apart, is not as the compiled runs have it."""
    tuning = scene.tuning
    if not scene.commanded:
        return f"of a {scene.world.system}"
    if scene.guard == "skip":
        return "with guard skip"
    if tuning.range_variance != "prediction":
        return "with rangeVariance"
    return "without cross covariances" if tuning.cross_covariances != "kept" else None
