"""The last view of a run as a small picture, which carries the verdict."""

from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from ekfsim.localization import play
from ekfsim.provenance import metadata
from ekfsim.scene import Scene
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Frame
from ekfsim.views.picture.look import STANDARD, Paper
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import View

SMALL = Paper(dpi=72)
COLORS, ROUNDS = 20, 5  # of its palette, and how often that is mended


def draw_last(scene: Scene, target: Path) -> tuple[View, tuple[int, int]]:
    """Play a scene and draw its last view into a .png; the view, and the picture's size in px."""
    scope = scopes.of(scene, play(scene), STANDARD.probability)
    *_, last = views(play(scene))
    pixels = Frame(scene, scope, STANDARD, SMALL).rgba(last)
    picture = Image.fromarray(np.ascontiguousarray(pixels[..., :3]))
    few = picture.quantize(COLORS, kmeans=ROUNDS, dither=Image.Dither.NONE)
    notes = PngInfo()
    for name, told in metadata(scene).items():
        notes.add_itxt(name, told)
    few.save(target, "PNG", optimize=True, pnginfo=notes)
    return last, few.size
