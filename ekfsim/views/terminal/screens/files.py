"""Pictures in files: one that is rewritten for every view, and those that are saved."""

import itertools
import os
from pathlib import Path
from typing import TYPE_CHECKING

from ekfsim.errors import EkfsimError
from ekfsim.files.results.writing import whole_file
from ekfsim.provenance import metadata
from ekfsim.scene import Scene
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.look import Look, get_ready
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.keys.bindings import Action
from ekfsim.views.terminal.screens.moment import Moment

if TYPE_CHECKING:
    from ekfsim.views.picture.frames import Frame


class Pictures:
    """Writes pictures to a folder."""

    keeps = False

    def __init__(self, scene: Scene, extent: Scope, look: Look, out: Path, force: bool) -> None:
        self._look, self._out, self._force = look, out, force
        self.turn_to(scene, extent)

    def turn_to(self, scene: Scene, extent: Scope) -> None:
        """The next views are of this scene."""
        self._scene, self._extent = scene, extent
        self._frame: Frame | None = None
        self._shown: View | None = None

    def show(self, moment: Moment) -> None:
        """Rewrite the current picture in place."""
        if moment.view is not self._shown:
            self._shown = moment.view
            self._write(moment.view, self._out / "current.png", force=True)

    def arrange(self, action: Action, count: int) -> str:
        """There is nothing to arrange."""
        return "The picture is in its file"

    def wait(self, note: str) -> None:
        """Nothing: the picture stays."""

    def save(self, view: View) -> str:
        """Save the picture of a view under its step, beside those saved of it before;
        says where, or why not.
        """
        name = view.named()
        path = self._out / f"{name}.png"
        for again in itertools.count(2):
            if self._force or not os.path.lexists(path):
                break
            path = self._out / f"{name}-{again}.png"
        try:
            self._write(view, path, self._force)
        except EkfsimError as refusal:
            return str(refusal)
        return f"Saved {path}"

    def _write(self, view: View, path: Path, force: bool) -> None:
        if self._frame is None:
            get_ready()
            from ekfsim.views.picture.frames import Frame

            self._frame = Frame(self._scene, self._extent, self._look)
        with whole_file(path, force) as beside:
            beside.write_bytes(self._frame.png(view, metadata(self._scene)))
