"""`ekfsim run`, narrative included, against filterpy's predict and update with a range from
shapely, per command.

As many moves as beams, among more and more walls. filterpy draws no random number, judges nothing
and writes no narrative. Its Jacobian is given to it, or taken by differences from three more
ranges, as shapely tells no wall.

python benchmarks/run.py [--quick]
"""

import argparse
import math
from collections.abc import Callable

import numpy as np
import shapely
from timing import optional, ratios

from ekfsim.commands import Move, Repeat, Sense
from ekfsim.diagnostics.summary import Summary
from ekfsim.floor import Map, Obstacle
from ekfsim.geometry import Array
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.views.playback.playback import views
from ekfsim.views.words.closing import conclude
from ekfsim.views.words.narrative.narrating import narrate
from ekfsim.world import Noise, Told, World

COMMANDS = 1000
NOISE = Noise(0.01, 0.01, 0.002, 0.002, 0.01)
REACH = 50.0  # m, longer than the room

Cast = Callable[[float, float, float], float]
Jacobian = Callable[[Array], Array]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--quick", action="store_true", help="fewer rounds, and not the largest world"
    )
    quick = parser.parse_args().quick
    with_filterpy = optional("filterpy") is not None
    for pillars in (30, 250) if quick else (30, 250, 1000):
        scene = furnished(pillars)
        rings = [shapely.LinearRing(points) for _, points in scene.world.map.rings()]
        casts = {"one union": by_union(rings), "STRtree": by_tree(rings)}
        peers = {
            f"filterpy + shapely {name}, {how}": peer(cast, jacobian(cast))
            for name, cast in casts.items()
            for how, jacobian in (("H given", given), ("H by differences", differences))
        }
        print(
            f"{COMMANDS} commands among {pillars} obstacles, "
            f"{len(scene.world.map.walls.segments)} walls"
        )
        for ratio in ratios(
            lambda s=scene: narrative(s), peers if with_filterpy else {}, 3 if quick else 7, 0.5
        ):
            print(ratio)


def furnished(pillars: int) -> Scene:
    """A room of 20 m by 16 m with square pillars in two corners, and a robot that drives round a
    square beside them.
    """
    lattice = math.ceil(math.sqrt(pillars / 2))
    pitch = 5 / lattice
    places = [
        (14 + pitch * (i // 2 % lattice), (0.3 if i % 2 else 10.8) + pitch * (i // 2 // lattice))
        for i in range(pillars)
    ]
    corners = pitch / 2 * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    obstacles = tuple(
        Obstacle(f"pillar {n}", np.array(place) + corners) for n, place in enumerate(places)
    )
    room = Map(np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 16.0], [0.0, 16.0]]), obstacles)
    start = np.array([4.0, 8.0, 0.0])
    world = World("pillars", room, start, np.zeros(3), NOISE, Told(start, np.zeros(3), NOISE, room))
    lap = (Move(1.0, math.pi / 2), Sense(0.0), Move(1.0, math.pi / 2), Sense(math.pi / 2))
    return Scene(world, (Repeat(COMMANDS // len(lap), lap),))


def narrative(scene: Scene) -> int:
    """What `ekfsim run` does: every step, every line of the narrative, the verdict. How many
    characters that is.
    """
    characters, summary = 0, Summary()
    for view in views(play(scene)):
        characters += len(narrate(view, scene))
        if not view.beam:
            summary.add(view.step)
    return characters + len(conclude(summary))


def peer(cast: Cast, jacobian: Jacobian) -> Callable[[], object]:
    """As many predicts and updates with filterpy as there are commands, each with a range of
    shapely's.
    """
    from filterpy.kalman import ExtendedKalmanFilter

    controls = np.array([[1.0], [math.pi / 2]])

    class Robot(ExtendedKalmanFilter):  # type: ignore[misc]
        def predict_x(self, u: Array = controls) -> None:
            x, y, θ = self.x[:, 0]
            self.x = np.array(
                [[x + u[0, 0] * math.cos(θ)], [y + u[0, 0] * math.sin(θ)], [θ + u[1, 0]]]
            )

    def predicted(x: Array) -> Array:
        return np.array([[cast(*x[:, 0])]])

    def run() -> object:
        robot = Robot(dim_x=3, dim_z=1)
        robot.Q, robot.P, robot.R = np.eye(3) * 1e-4, np.eye(3) * 1e-3, np.eye(1) * 1e-3
        for _ in range(COMMANDS):
            robot.x = np.array([[4.0], [8.0], [0.3]])
            robot.predict(u=controls)
            robot.update(np.array([[8.0]]), jacobian, predicted)
        return robot

    return run


def given(cast: Cast) -> Jacobian:
    """A Jacobian that costs nothing."""
    return lambda x: np.array([[math.cos(x[2, 0]), math.sin(x[2, 0]), 0.1]])


def differences(cast: Cast) -> Jacobian:
    """The Jacobian by forward differences."""

    def jacobian(x: Array) -> Array:
        pose, step = x[:, 0], 1e-6
        r = cast(*pose)
        return np.array([[(cast(*(pose + step * axis)) - r) / step for axis in np.eye(3)]])

    return jacobian


def by_union(rings: list[shapely.LinearRing]) -> Cast:
    """The first thing one writes: the distance to the beam's intersection with the union of all
    walls.
    """
    walls = shapely.unary_union(rings)

    def cast(x: float, y: float, heading: float) -> float:
        beam = shapely.LineString(
            [(x, y), (x + REACH * math.cos(heading), y + REACH * math.sin(heading))]
        )
        return float(shapely.Point(x, y).distance(beam.intersection(walls)))

    return cast


def by_tree(rings: list[shapely.LinearRing]) -> Cast:
    """The same with a tree over the polygons' rings."""
    tree = shapely.STRtree(rings)

    def cast(x: float, y: float, heading: float) -> float:
        beam = shapely.LineString(
            [(x, y), (x + REACH * math.cos(heading), y + REACH * math.sin(heading))]
        )
        near = tree.geometries.take(tree.query(beam, predicate="intersects"))
        return float(
            np.min(shapely.distance(shapely.Point(x, y), shapely.intersection(beam, near)))
        )

    return cast


if __name__ == "__main__":
    main()
