"""Every figure and table of the five documents, and the gallery, each by one command: `ekfsim
figures NAME -o DIR`.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ekfsim.figures.album import PATTERNS, Album
from ekfsim.figures.classroom.document import draw_classroom
from ekfsim.figures.classroom.gallery import draw_gallery
from ekfsim.figures.gnss.document import draw_gnss
from ekfsim.figures.mower.document import draw_mower
from ekfsim.figures.pioneer.document import draw_pioneer
from ekfsim.figures.pylon.document import draw_pylon
from ekfsim.files.results.writing import whole_folder
from ekfsim.provenance import told_in_a_line

if TYPE_CHECKING:
    from ekfsim.scene import Scene

TITLES = {
    "classroom": "Localization and the extended Kalman filter: the teaching assignment",
    "mower": "Three-state extended Kalman filter for mobile robot localization: the golf-course "
    "mower",
    "pioneer": "State estimation based on Kalman filtering techniques in navigation: the P3 robot",
    "gnss": "Sensor fusion for a lawn mower: GNSS and wheel speeds",
    "pylon": "Extended Kalman filter for localization: lidar and IMU around a pylon",
    "gallery": "Scenarios that make the filter fail",
}
FIGURES: dict[str, Callable[["Scene", Album], None]] = {
    "classroom": draw_classroom,
    "mower": draw_mower,
    "pioneer": draw_pioneer,
    "gnss": draw_gnss,
    "pylon": draw_pylon,
    "gallery": draw_gallery,
}


def draw_figures(
    name: str, scene: "Scene", out: Path, formats: tuple[str, ...], force: bool
) -> list[str]:
    """Draw all figures of a document into a folder, with captions.md;
    the names of what was written.

    scene : the document's scene, simulated or recorded
    """
    whence = "From the simulated twin: " if scene.log is None else "From the recorded log: "
    with whole_folder(out, *PATTERNS, force=force) as folder:
        album = Album(TITLES[name], whence + told_in_a_line(scene), folder, formats)
        FIGURES[name](scene, album)
        album.close()
        written = sorted(path.name for path in folder.iterdir())
    return written
