"""The figures of the document classroom."""

from ekfsim.figures.album import Album
from ekfsim.scene import Scene


def draw_classroom(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
