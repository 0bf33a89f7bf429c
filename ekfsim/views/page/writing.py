"""A page as a file: whole or absent."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from ekfsim.files.results.writing import refuse_existing, whole_text
from ekfsim.localization import play
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.page.page import Page
from ekfsim.views.picture.look import STANDARD, Look


@dataclass(frozen=True)
class Played:
    """The steps of a scene, played anew each time they are asked for."""

    scene: Scene
    heed: Callable[[], object] = lambda: None  # called at each of them

    def __iter__(self) -> Iterator[Step]:
        for step in play(self.scene):
            self.heed()
            yield step


def write(
    scene: Scene,
    target: Path,
    look: Look = STANDARD,
    every: int = 1,
    force: bool = False,
    heed: Callable[[], object] = lambda: None,
    reason: str = "",
) -> Page:
    """Play a scene and write its page; what comes back tells how many views it holds.

    heed : called at each step, to end it all; reason : why the run was lost, as it is told
    Raises UsageError where the file exists (without `force`).
    """
    refuse_existing(target, force)
    made = Page.of(scene, [Played(one, heed) for one in scene.alone()], look, every, reason)
    with whole_text(target, force) as file:
        file.write(made.text)
    return made
