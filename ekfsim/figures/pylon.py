"""The figures of the document pylon."""

from ekfsim.figures.album import Album
from ekfsim.scene import Scene


def draw_pylon(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
