"""A run as it plays in a cell: the page of `render -o lesson.html`, inline."""

from dataclasses import dataclass
from html import escape
from pathlib import Path

from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.views.page.page import page
from ekfsim.views.picture.look import STANDARD, Look

HEIGHT = 760  # pixels


@dataclass(frozen=True, repr=False)
class Animation:
    """The page of a run."""

    html: str  # what `render -o lesson.html` writes
    height: int

    def __repr__(self) -> str:
        return f"Animation({len(self.html) // 1000} kB of HTML)"

    def _repr_html_(self) -> str:
        """In a frame that may run its own script, and reach nothing of the notebook."""
        return (
            f'<iframe srcdoc="{escape(self.html)}" sandbox="allow-scripts" title="the run" '
            f'style="width: 100%; height: {self.height}px; border: 0"></iframe>'
        )


def animate(scene: Scene | str | Path, look: Look = STANDARD, height: int = HEIGHT) -> Animation:
    """The run of a scene as a page that plays in the cell: n, p, space, a slider, a click on the
    curves beneath. All filters that watch are in it. height : of the frame, in pixels
    """
    if not isinstance(scene, Scene):
        scene = load_scene(scene)
    return Animation(page(scene, [list(play(one)) for one in scene.alone()], look), height)
