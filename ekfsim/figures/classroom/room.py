"""A view of the classroom, no wider than its room."""

from typing import Any

from matplotlib.axes import Axes

from ekfsim.scene import Scene
from ekfsim.views.notebook.drawing import draw
from ekfsim.views.picture.look import Look
from ekfsim.views.picture.panels import Main
from ekfsim.views.playback.view import View

MARGIN = 0.4  # m around a room
NEVER_IN_THESE = ("… is refused",)


def room(axes: Axes, view: View, scene: Scene, look: Look) -> tuple[list[Any], list[str]]:
    """Draw a view no wider than its room,
    and the legend's handles and words of what can be in it.
    """
    picture = draw(view, scene, axes, look, legend=False)
    assert isinstance(picture, Main)
    assert scene.world.map.boundary is not None
    (left, bottom), (right, top) = (
        scene.world.map.boundary.min(axis=0),
        scene.world.map.boundary.max(axis=0),
    )
    axes.set(xlim=(left - MARGIN, right + MARGIN), ylim=(bottom - MARGIN, top + MARGIN))
    axes.set_aspect("equal", adjustable="box")
    named = {
        str((handle[0] if isinstance(handle, tuple) else handle).get_label()): handle
        for handle in picture.handles()
    }
    kept = {word: handle for word, handle in named.items() if word not in NEVER_IN_THESE}
    return list(kept.values()), list(kept)
