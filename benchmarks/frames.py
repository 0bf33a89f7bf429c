"""How long one picture takes as a PNG file of 900 × 700 pixels: ours against ir-sim's, of a like
scene.

    python benchmarks/frames.py

The scene: a room with 30 obstacles, a robot with a beam, and the path of 200 corners behind it.
ir-sim steps, renders and saves its figure at the same size; it draws no ellipse, no cone, no legend
and no close-up.
"""

import math
import os
import sys
import tempfile
from collections.abc import Callable
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from timing import optional, ratios

from ekfsim.commands import Move, Sense
from ekfsim.floor import Map, Obstacle
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.views.picture.extent import scope
from ekfsim.views.picture.frames import Frame, Picture
from ekfsim.views.picture.look import STANDARD
from ekfsim.views.playback.playback import views
from ekfsim.world import Noise, Told, World

SIDE = 10.0  # m
DESKS = [(0.8 + 1.5 * (i % 6), 0.8 + 1.7 * (i // 6)) for i in range(30)]  # lower left corners, in m
CORNERS = 200  # of the path behind the robot


def main() -> None:
    """Print the ratios."""
    scene = classroom()
    shown = list(views(play(scene)))[-20:]
    extent = scope.of(scene, play(scene))
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        frame, coming, target = Frame(scene, extent), cycle(shown), Path("ours.png")
        peers = {"a new matplotlib figure each": anew(scene, extent, cycle(shown)), **by_irsim()}
        print("How many times as long as ours a picture takes:")
        for ratio in ratios(
            lambda: target.write_bytes(frame.png(next(coming))), peers, rounds=15, seconds=0.2
        ):
            print(ratio)


def classroom() -> Scene:
    """A room with 30 desks, and a robot that goes round them."""
    desks = tuple(Obstacle(f"desk {i}", rectangle(x, y)) for i, (x, y) in enumerate(DESKS))
    plan, noise = (
        Map(SIDE * np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), desks),
        Noise(0.01, 0.01, 0.01, 0.01, 0.01),
    )
    start, sigma = np.array([0.4, 0.4, 0.0]), np.array([0.1, 0.1, 0.05])
    side = [Move(9 / (CORNERS / 4), 0.0)] * (CORNERS // 4)
    course = [
        *side,
        Move(0.0, math.pi / 2),
        *side,
        Move(0.0, math.pi / 2),
        *side,
        Move(0.0, math.pi / 2),
        *side,
    ]
    beams = [Sense(math.radians(angle)) for angle in range(0, 360, 30)]
    return Scene(
        World("classroom", plan, start, np.zeros(3), noise, Told(start, sigma, noise, plan)),
        (*course, *beams),
    )


def rectangle(x: float, y: float) -> Any:
    """A desk : (4, 2) m"""
    return np.array([[x, y], [x + 0.8, y], [x + 0.8, y + 0.5], [x, y + 0.5]])


def anew(scene: Scene, extent: scope.Scope, coming: Any) -> Callable[[], object]:
    """The same picture without a kept background: everything is drawn for each."""

    def task() -> None:
        figure = Figure(figsize=(9, 7), dpi=100)
        FigureCanvasAgg(figure)
        picture = Picture(figure, scene, extent, STANDARD)
        picture.show(next(coming))
        figure.savefig("anew.png")

    return task


def by_irsim() -> dict[str, Callable[[], object]]:
    """ir-sim's own way, without a window."""
    os.environ["MPLBACKEND"] = "Agg"
    sys.path.insert(0, os.getcwd())  # its pictures go to a folder in the first of these
    # it looks for windows, and says so
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        irsim: Any = optional("irsim")
    if irsim is None:
        print("skipped: irsim is not installed", file=sys.stderr)
        return {}
    obstacles = [
        {"shape": {"name": "polygon", "vertices": rectangle(x, y).tolist()}, "state": [0, 0, 0]}
        for x, y in DESKS
    ]
    sensor = {"name": "lidar2d", "range_min": 0, "range_max": 15, "angle_range": 0.01, "number": 1}
    robot = {
        "kinematics": {"name": "diff"},
        "shape": {"name": "circle", "radius": 0.22},
        "state": [0.4, 0.4, 0],
        "goal": [9.6, 0.4, 0],
        "behavior": {"name": "dash"},
        "sensors": [sensor],
        "plot": {"show_trajectory": True},
    }
    world = {"height": SIDE, "width": SIDE, "collision_mode": "unobstructed"}
    Path("world.yaml").write_text(
        yaml.safe_dump({"world": world, "robot": robot, "obstacle": obstacles})
    )
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        environment = irsim.make("world.yaml", disable_all_plot=False, log_level="ERROR")
    environment._env_plot.fig.set_size_inches(9, 7)

    def task() -> None:
        environment.step()
        environment.render(0.001)  # it sleeps so long, which takes no processor time
        environment.save_figure("theirs.png", dpi=100)

    return {"ir-sim step, render, save_figure": task}


if __name__ == "__main__":
    main()
