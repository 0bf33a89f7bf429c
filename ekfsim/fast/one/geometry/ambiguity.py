"""Whether a beam of one robot could as well meet another wall, in plain floats."""

import math

import numpy as np

from ekfsim.diagnostics.ambiguity import FLAT, REACH, BeamSensor, Sighting
from ekfsim.fast.one.geometry.ground import reach_of_each
from ekfsim.fast.one.normal import normal_one
from ekfsim.geometry import Array
from ekfsim.raycast.searches.single_beam import first, found


def sighting(beam: BeamSensor, x: Array, P: Array) -> Sighting | None:
    """Twin of `sighting`, of one pose; each of the seven beams is followed by itself."""
    if x.ndim != 1:
        return None
    λ, V = (found.tolist() for found in np.linalg.eigh(P))
    walls, bearing = beam.walls, beam.bearing
    px, py, θ = x.tolist()
    reaches = [REACH * math.sqrt(λ_i) if λ_i > FLAT * λ[2] else 0.0 for λ_i in λ]
    arms = [
        (reach * vx, reach * vy, reach * vθ)
        for sign in (1.0, -1.0)
        for reach, vx, vy, vθ in zip([sign * reach for reach in reaches], *V, strict=True)
    ]
    shares = reach_of_each(walls.ground, px, py, arms)
    probes = [
        (px + t * dx, py + t * dy, θ + t * dθ) for t, (dx, dy, dθ) in zip(shares, arms, strict=True)
    ]
    r, wall = here = first(walls, px, py, θ + bearing)
    hits = [
        found(walls, x_i, y_i, θ_i + bearing) if any(arm) else here
        for (x_i, y_i, θ_i), arm in zip(probes, arms, strict=True)
    ]
    ranges, met = zip(*hits, strict=True)
    incidence, line = math.nan, walls.line
    if wall >= 0:
        dx, dy = math.cos(θ + bearing), math.sin(θ + bearing)
        nx, ny = normal_one(walls, wall, px + r * dx, py + r * dy)
        incidence = math.asin(min(abs(nx * dx + ny * dy), 1.0))
    astray = [
        other != wall and (wall < 0 or other < 0 or line[other] != line[wall]) for other in met
    ]
    return Sighting(*map(np.array, (wall, incidence, probes, ranges, met, astray)))
