"""The figures of the document gnss."""

from ekfsim.figures.album import Album
from ekfsim.scene import Scene


def draw_gnss(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
