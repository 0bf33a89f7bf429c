"""The figures of the document pioneer."""

from ekfsim.figures.album import Album
from ekfsim.scene import Scene


def draw_pioneer(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
