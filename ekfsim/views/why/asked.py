"""How many runs stand behind a name where nobody says it: fewer of filters that take long."""

from ekfsim.filters import FILTERS
from ekfsim.filters.tuning import reads
from ekfsim.scene import Scene

MANY, FEW = 1000, 100


def is_quick(scene: Scene) -> bool:
    """Whether the scene's filter calculates many runs side by side: not one of particles, of which
    each run has its own crowd, nor one of one's own, which is called for each run.

    >>> from ekfsim import load_scene
    >>> is_quick(load_scene("tour")), is_quick(load_scene("tour").with_(filter="pf"))
    (True, False)
    """
    return scene.filter in FILTERS and not reads(scene.filter, "particles")


def runs_for(scene: Scene) -> int:
    """How many runs are asked while somebody waits."""
    return MANY if is_quick(scene) else FEW
