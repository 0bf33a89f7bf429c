"""The figures of the document mower."""

from ekfsim.figures.album import Album
from ekfsim.scene import Scene


def draw_mower(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
