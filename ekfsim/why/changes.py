"""Every change of a scene, each alone."""

from collections.abc import Iterator
from dataclasses import replace

from ekfsim.scene import Scene
from ekfsim.why.records import Change

RATIOS = {
    "execution_distance": "executionDstSigmaRatio",
    "execution_angle": "executionAngSigmaRatio",
    "odometry_distance": "odometryDstSigmaRatio",
    "odometry_angle": "odometryAngSigmaRatio",
    "range": "rangeSigmaRatio",
}


def changes_of(scene: Scene) -> Iterator[Change]:
    """What can be put right in a scene."""
    world = scene.world
    for name, key in RATIOS.items():
        told, true = getattr(world.told.noise, name), getattr(world.noise, name)
        if told != true:
            yield _ratio(name, key, told, true)


def _ratio(name: str, key: str, told: float, true: float) -> Change:
    def right(scene: Scene) -> Scene:
        world = scene.world
        noise = replace(world.told.noise, **{name: true})
        return replace(scene, world=replace(world, told=replace(world.told, noise=noise)))

    return Change("noise", f"the told {key}", f"{told:g} told, {true:g} true", None, right)
