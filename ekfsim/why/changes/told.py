"""What the filter is told, made true: the numbers of its noise, its start and how sure it is of
it.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.scene import Scene
from ekfsim.why.records import Change, Kind
from ekfsim.world import Told, World

RATIOS = {
    "execution_distance": "executionDstSigmaRatio",
    "execution_angle": "executionAngSigmaRatio",
    "odometry_distance": "odometryDstSigmaRatio",
    "odometry_angle": "odometryAngSigmaRatio",
    "range": "rangeSigmaRatio",
}
ODOMETRY = "odometry_distance", "odometry_angle"


def ratios(world: World, names: Sequence[str] = tuple(RATIOS)) -> Iterator[Change]:
    """Each told ratio that is not the true one, made true by itself."""
    for name in names:
        told, true = getattr(world.told.noise, name), getattr(world.noise, name)
        if told != true:
            yield _ratio(name, told, true)


def overtrusted(world: World, names: Sequence[str]) -> bool:
    """Whether the filter is told less noise than there is, of all these together."""
    told, true = (
        math.prod(max(getattr(noise, name), 1e-9) for name in names)
        for noise in (world.told.noise, world.noise)
    )
    return told < true


def starts(world: World) -> Iterator[Change]:
    """The told start and how sure the filter is told to be of it, each by itself."""
    told = world.told
    if off := _off(told.start, world.start):
        yield told_change("start", "the told start", off, lambda w: replace(w.told, start=w.start))
    if (told.sigma != world.start_sigma).any():
        text = f"{_axes(told.sigma)} told, {_axes(world.start_sigma)} true"
        yield told_change(
            "sigma", "the told sigma of the start", text,
            lambda w: replace(w.told, sigma=w.start_sigma),
        )  # fmt: skip


def told_change(kind: Kind, name: str, text: str, right: Callable[[World], Told]) -> Change:
    """A change of what the filter is told."""

    def of_scene(scene: Scene) -> Scene:
        return replace(scene, world=replace(scene.world, told=right(scene.world)))

    return Change(kind, name, text, of_scene=of_scene)


def _ratio(name: str, told: float, true: float) -> Change:
    text = f"{told:g} told, {true:g} true"
    return told_change(
        "noise", f"the told {RATIOS[name]}", text,
        lambda w: replace(w.told, noise=replace(w.told.noise, **{name: true})),
    )  # fmt: skip


def _off(told: Array, true: Array) -> str:
    """How far the told start is off; "" where it is not."""
    x, y, θ = (told - true).tolist()
    distance, turn = math.hypot(x, y), abs(math.degrees(float(wrap(θ))))
    off = [f"{distance:.3g} m"] if distance else []
    off += [f"{turn:.3g} degrees"] if turn else []
    return f"{' and '.join(off)} off" if off else ""


def _axes(sigma: Array) -> str:
    """Standard deviations of x, y and θ, as a text."""
    x, y, θ = sigma.tolist()
    return f"{x:g} m, {y:g} m, {math.degrees(θ):.4g} degrees"


def surer(world: World) -> bool:
    """Whether the filter is told another start, or is surer of it than it may be."""
    told = world.told
    return bool(_off(told.start, world.start)) or bool((told.sigma < world.start_sigma).any())
