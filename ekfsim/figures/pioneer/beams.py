"""Document 001, figures 4 and 6:
what an infrared pair and an ultrasonic beam say of a wall, over its distance.
"""

import math

import numpy as np

from ekfsim.figures.album import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILLION, Album, labelled
from ekfsim.geometry import Array
from ekfsim.models.sensors.infrared import COLOURS, InfraredBeam
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.raycast.walls import Walls
from ekfsim.scene import Scene
from ekfsim.simulation.bench import readings
from ekfsim.systems.instruments import Infrared, Ultrasonic

# of the curves
SHADES = {"white": ORANGE, "red": VERMILLION, "blue": BLUE, "green": GREEN, "black": BLACK}
EACH = 200  # ultrasonic readings at each distance
INFRARED = """
What a pair of emitter and receiver says of a wall {nearest:g} to {farthest:g} m in front of it, for
five colours: lines are the model I = ρ (offset − gain ln r), dots simulated readings with σ =
{sigma:g} V. On the right the same over the logarithm of the distance: straight lines, whose slope
is the colour. So an intensity alone is no distance: {volt:.2f} V is a white wall at {far:.2f} m or
a blue one at {near:.2f} m, and the filter has to be told the colour of its walls.

Compared with the print: the text says of figure 4 that the dependency is almost logarithmic and
that the colour has an important impact, and so it is here, by the model. It prints no numbers: gain
{gain:g} V per e-fold, offset {offset:g} V and the reflectances ρ are ours.
"""
ULTRASONIC = """
The error of {each} simulated readings at each of {n} distances from {nearest:g} to {farthest:g} m.
Left: |error| (dots), its root mean square at each distance (circles), and what the filter is told,
σ(r) = {sigma:g} mm + {slope:g} mm/m · r (line). Right: the variance of the error, with the same
σ²(r), and the constant one that would fit on average (dashed), {low:.1f} times too large at the
near end and {high:.1f} times too small at the far end. {each} readings leave ± {scatter:.0f} % of σ
to chance; the worst circle is {worst:.0f} % off.

Compared with the print: figure 6 is the document's reason for a covariance that depends on the
distance; it prints no numbers, so that σ(r) is ours. The model has no outliers: no second echoes
and no crosstalk, which a real room has.
"""


def facing(distance: Array) -> Array:
    """Poses that look at the wall from distances in m : (…, 3)"""
    return np.stack([distance, np.zeros_like(distance), np.full_like(distance, math.pi)], axis=-1)


def inside(nearest: float, farthest: float, n: int) -> Array:
    """Distances that a sensor reads, whatever rounding a ray leaves : (n,) m"""
    return np.linspace(nearest + 1e-9, farthest - 1e-9, n)


def a_wall() -> Walls:
    """One wall, along x = 0."""
    return Walls.of({"wall": np.array([[0.0, -1.0], [0.0, 1.0], [-0.1, 1.0], [-0.1, -1.0]])})


def infrared_beam(pair: Infrared, colour: str) -> InfraredBeam:
    """The pair, looking straight ahead at a wall of a colour."""
    return InfraredBeam(
        a_wall(),
        0.0,
        pair.gain,
        pair.offset,
        COLOURS[colour],
        pair.sigma,
        pair.nearest,
        pair.farthest,
    )


def draw_infrared(scene: Scene, album: Album) -> None:
    """Figure 4."""
    pair = next(
        (kind for kind in scene.world.instruments if isinstance(kind, Infrared)), Infrared()
    )
    generator = np.random.default_rng([scene.seed, 4])
    r = inside(pair.nearest, pair.farthest, 141)
    figure = album.figure(9.6, 4.2)
    left, right = figure.subplots(1, 2, sharey=True)
    for colour, shade in SHADES.items():
        beam = infrared_beam(pair, colour)
        z = readings(beam, facing(r), generator)[..., 0]
        for axes in (left, right):
            axes.plot(r, z, ".", color=shade, ms=2.5, alpha=0.5)
            axes.plot(
                r,
                beam.h(facing(r))[..., 0],
                color=shade,
                lw=1.6,
                label=f"{colour}, ρ = {COLOURS[colour]:g}",
            )
    labelled(left, "distance r (m)", "intensity I (V)").legend(
        title="wall", fontsize=8, title_fontsize=8
    )
    labelled(right, "distance r (m), logarithmic", "").set(xscale="log")
    ticks = [
        tick
        for tick in (0.05, 0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 5.0)
        if pair.nearest <= tick <= pair.farthest
    ]
    right.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    right.minorticks_off()
    volt = COLOURS["blue"] * (pair.offset - pair.gain * math.log(2 * pair.nearest))
    album.add(
        figure, "fig4-infrared", "Figure 4: infrared intensity over distance",
        INFRARED.format(
            nearest=pair.nearest, farthest=pair.farthest, sigma=pair.sigma, gain=pair.gain,
            offset=pair.offset,
            volt=volt, far=math.exp((pair.offset - volt) / pair.gain), 
            near=2 * pair.nearest,
        ),
    )  # fmt: skip


def draw_ultrasonic(scene: Scene, album: Album) -> None:
    """Figure 6."""
    ring = next(
        (kind for kind in scene.world.instruments if isinstance(kind, Ultrasonic)), Ultrasonic()
    )
    beam = UltrasonicBeam(
        a_wall(), 0.0, ring.sigma, ring.sigma_per_metre, ring.nearest, ring.farthest
    )
    r = inside(ring.nearest, ring.farthest, 39)
    poses = np.broadcast_to(facing(r)[:, None], (len(r), EACH, 3))
    # mm
    error = (
        readings(beam, poses, np.random.default_rng([scene.seed, 6]))[..., 0] - r[:, None]
    ) * 1e3
    σ, rms = (
        np.sqrt(beam.linearize(facing(r))[2][..., 0, 0]) * 1e3,
        np.sqrt(np.mean(error**2, axis=1)),
    )
    even = float(np.mean(σ**2))
    figure = album.figure(9.6, 4.2)
    left, right = figure.subplots(1, 2)
    left.plot(
        np.repeat(r, 60),
        np.abs(error[:, :60]).ravel(),
        ".",
        color=GREY,
        ms=2,
        alpha=0.35,
        rasterized=True,
    )
    left.plot([], [], ".", color=GREY, label="|error| of single readings")
    left.plot(r, rms, "o", color=BLUE, ms=4, label=f"root mean square of {EACH}")
    left.plot(r, σ, color=VERMILLION, lw=1.8, label="σ(r) of the model")
    right.plot(r, rms**2, "o", color=BLUE, ms=4, label=f"mean square of {EACH}")
    right.plot(r, σ**2, color=VERMILLION, lw=1.8, label="σ²(r) of the model")
    right.axhline(even, color=BLACK, ls="--", lw=1.2, label="one variance for all distances")
    labelled(left, "distance r (m)", "absolute error (mm)").set(ylim=(0, None))
    labelled(right, "distance r (m)", "variance of the error (mm²)").set(ylim=(0, None))
    for axes in (left, right):
        axes.legend(fontsize=8, loc="upper left")
    album.add(
        figure, "fig6-ultrasonic", "Figure 6: ultrasonic error over distance",
        ULTRASONIC.format(
            each=EACH, n=len(r), nearest=ring.nearest, farthest=ring.farthest,
            sigma=ring.sigma * 1e3,
            slope=ring.sigma_per_metre * 1e3, low=even / σ[0] ** 2, high=σ[-1] ** 2 / even,
            scatter=100 / math.sqrt(2 * EACH), worst=100 * np.max(np.abs(rms / σ - 1)),
        ),
    )  # fmt: skip
