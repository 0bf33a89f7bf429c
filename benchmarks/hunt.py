"""How many lists of commands a hunt looks at in a minute, and whether it reaches what it should:
python benchmarks/hunt.py [LISTS]

Lists of at most 8 commands, 64 runs of each; the best of every round take 192 runs more. Seconds
are those of the processors, so that a neighbour does not count; of one process each.
"""

import sys
from time import perf_counter, process_time

from ekfsim.files.scenes.load import load_scene, load_world
from ekfsim.hunting.exposing import exposing
from ekfsim.hunting.hunt import Asked, hunt
from ekfsim.scene import Scene
from ekfsim.student.exposing.exposed import possible
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.study.results import Share
from ekfsim.twins import Way
from ekfsim.world import World

LISTS = 8000
ROOMS = "furnished-room", "room-with-desk", "people"


def own_room() -> World:
    """A furnished room that does not come along."""
    return World.of(
        name="study",
        boundary=[[0, 0], [7, 0], [7, 5], [0, 5]],
        obstacles={
            "shelf": [[0, 3], [0.4, 3], [0.4, 5], [0, 5]],
            "desk": [[3, 2], [4.6, 2], [4.6, 2.8], [3, 2.8]],
            "chair": [[3.4, 1.2], [3.9, 1.2], [3.9, 1.7], [3.4, 1.7]],
            "bed": [[5, 3.6], [7, 3.6], [7, 5], [5, 5]],
        },
        start=(1, 1, 0),
        noise=load_world("furnished-room").noise,
    )


def in_room(world: World | str) -> Scene:
    """Nothing is done yet."""
    return load_scene({"commands": [], **({"world": world} if isinstance(world, str) else {})},
                      None if isinstance(world, str) else world)  # fmt: skip


def pace(scene: Scene, way: Way, lists: int) -> None:
    """Lists a minute of one process's own time."""
    hunt(Asked(scene, lists=128, way=way, runs=64), *ears())  # compiled, and imported
    began = process_time()
    found = hunt(Asked(scene, lists=lists, way=way, seconds=3600, runs=64), *ears())
    minute = 60 * found.search.looked_at / (process_time() - began)
    print(f"{way:8s} {minute:9.0f} lists × 64 runs a minute of one processor (reach: 10 000)")


def reach(name: str, scene: Scene) -> None:
    """From nothing, within 60 s, a list that loses half of all runs."""
    began = perf_counter()
    found = hunt(Asked(scene, enough=0.5, runs=10_000), *ears())
    lost, seconds = Share(*found.fresh), perf_counter() - began
    n = len(found.scene.commands)
    print(
        f"{name}: {100 * lost.value:.3g} % lost by {n} commands, in {seconds:.1f} s (50 %, 8, 60)"
    )


def mistakes(scene: Scene) -> None:
    """By how many commands each known mistake is exposed."""
    began, can_be_made = perf_counter(), possible(scene, KNOWN)
    found = exposing(scene, 3)
    each = [sum(len(one) == n for one in found.values()) for n in (1, 2, 3)]
    print(
        f"{len(found)} of {len(can_be_made)} mistakes that can be made there are exposed: "
        f"{each[0]} by 1 command, {each[1]} by 2, {each[2]} by 3, in {perf_counter() - began:.1f} s"
    )
    for mistake in can_be_made - set(found):
        print(f"  not exposed: {mistake.name}")


def ears() -> tuple:  # type: ignore[type-arg]
    """Nobody listens, nothing ends it."""
    return (lambda *_: None), (lambda *_: None)


def main() -> None:
    lists = int(sys.argv[1]) if len(sys.argv) > 1 else LISTS
    scene = in_room("furnished-room")
    pace(scene, "compiled", lists)
    pace(scene, "quick", min(lists, 1000))
    for name in ROOMS:
        reach(name, in_room(name))
    reach("a room of its own", in_room(own_room()))
    mistakes(scene)


if __name__ == "__main__":
    main()
