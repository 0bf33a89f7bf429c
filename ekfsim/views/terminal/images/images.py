"""The picture of a view as an image on a terminal."""

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from ekfsim.scene import Scene
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.look import LOWEST, NARROWEST, Look, Paper, get_ready
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.images import protocols
from ekfsim.views.terminal.images.asking import Means, Protocol

if TYPE_CHECKING:
    from ekfsim.views.picture.frames import Frame

# dots to an inch for each pixel of a row of text: letters as high as the terminal's, smaller ones
# where that gives the map more room, and the smallest that can still be read
DENSITY, SMALLER, SPARSEST = 5.5, 4.2, 3.6
ROOMY = 8.0, 6.0  # inches of a picture that asks for no smaller ones
MOST = 1600  # px of a side of an image that the terminal enlarges
BAND = 6  # rows of pixels that are drawn together as sixels


@dataclass(frozen=True, slots=True)
class Box:
    """Cells of a terminal; row and column count from 0."""

    row: int
    column: int
    columns: int
    rows: int


class Images:
    """Draws views into a box of a terminal."""

    def __init__(self, scene: Scene, extent: Scope, look: Look, means: Means) -> None:
        self._look, self._means = look, means
        self._number = 0  # of the image that stands there, as kitty counts
        self.turn_to(scene, extent)

    def turn_to(self, scene: Scene, extent: Scope) -> None:
        """The next views are of this scene."""
        self._scene, self._extent = scene, extent
        self._frame = lru_cache(maxsize=2)(self._made)  # one for each size, of which few come back

    def fits(self, box: Box) -> bool:
        """Whether a picture in this box can be read."""
        _, dpi, dense = self._size(box)
        return dpi >= SPARSEST / DENSITY * dense

    def draw(self, view: View, box: Box) -> str:
        """What shows the picture of a view there, in place of the last one."""
        size, dpi, _ = self._size(box)
        frame = self._frame(size, dpi)
        place = f"\x1b[{box.row + 1};{box.column + 1}H"
        match self._means.protocol:
            case Protocol.SIXEL:
                from ekfsim.views.terminal.images.sixel import encoded, quantized

                return place + encoded(*quantized(frame.rgb(view), self._means.colours))
            case Protocol.ITERM2:
                return place + protocols.iterm2(frame.png(view), box.columns, box.rows)
            case Protocol.KITTY:
                number = 1 if self._number == 2 else 2
                shown = protocols.kitty(frame.png(view), number, box.columns, box.rows)
                last = self.removed()  # it goes when the new one is there
                self._number = number
                return "".join([place, *shown, last])

    def removed(self) -> str:
        """What takes away an image that does not go with the text of its cells."""
        gone = protocols.kitty_removed(self._number) if self._number else ""
        self._number = 0
        return gone

    def _size(self, box: Box) -> tuple[tuple[int, int], int, float]:
        """Width and height of the picture in px, its dots to an inch, and those it should have."""
        wide, high = self._means.cell
        width, height, dense = box.columns * wide, box.rows * high, DENSITY * high
        if self._means.protocol is Protocol.SIXEL:
            most = self._means.largest or (width, height)
            width, height = min(width, most[0]), min(height, most[1]) // BAND * BAND
        else:
            share = min(1.0, MOST / max(width, height))
            width, height, dense = int(width * share), int(height * share), dense * share
        roomy = max(min(width / ROOMY[0], height / ROOMY[1]), SMALLER / DENSITY * dense)
        dpi = min(dense, roomy, width / NARROWEST, height / LOWEST)
        return (width, height), int(dpi), dense

    def _made(self, size: tuple[int, int], dpi: int) -> "Frame":
        get_ready()
        from ekfsim.views.picture.frames import Frame

        return Frame(self._scene, self._extent, self._look, Paper(size, dpi))
