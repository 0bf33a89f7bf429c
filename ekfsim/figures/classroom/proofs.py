"""The inputs that prove the classroom's program:
what each must give, by hand, and what it gives.
"""

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.coverage import inside_cone, inside_ellipse
from ekfsim.diagnostics.nees import error
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import read_scene
from ekfsim.filters.belief import posed
from ekfsim.geometry.ellipse import cone_halfwidth, ellipse, radius_factor
from ekfsim.localization import play
from ekfsim.models.layout import POSE
from ekfsim.records import Step
from ekfsim.scene import Scene

P954 = 0.954
K = radius_factor(P954)
RUNS = 1000
STUDIED = (
    *("proof-dead-reckoning", "proof-unsure-start"),
    *("proof-coverage", "proof-every-mistake"),
)
# rad, m: of each corner and side in proof-square-twice
TURN_SIGMA, SIDE_SIGMA = 0.02 * math.pi / 2, 0.02 * 3


class Proof(NamedTuple):
    """One number that an input must give."""

    name: str
    what: str
    expected: float
    unit: str
    # from the steps in which the filter was given something, and the start
    measured: Callable[[list[Step]], float]


def shipped(name: str) -> Scene:
    """A scene that comes along."""
    return read_scene(packaged("commands")[name]).get()


def proof_rows() -> Iterator[list[str]]:
    """Input, what is looked at, expected and measured."""
    steps: dict[str, list[Step]] = {}
    for proof in PROOFS:
        if proof.name not in steps:
            steps[proof.name] = [
                s for s in play(shipped(proof.name)) if s.entry.given or s.entry.index == 0
            ]
        told = (
            f"{value:.4f}{proof.unit}"
            for value in (proof.expected, proof.measured(steps[proof.name]) + 0.0)
        )
        yield [proof.name, proof.what, *told]
    for name in STUDIED:
        *_, last = play(shipped(name), np.arange(RUNS))
        assert last.entry.truth is not None
        inside = (
            100 * float(np.mean(holds(posed(last.posterior, POSE), last.entry.truth, P954)))
            for holds in (inside_ellipse, inside_cone)
        )
        yield [name, f"{RUNS} runs: truth inside ellipse, inside cone", "95.4 %, 95.4 %",
               ", ".join(f"{share:.1f} %" for share in inside)]  # fmt: skip


def _major(i: int) -> Callable[[list[Step]], float]:
    return lambda steps: float(ellipse(steps[i].posterior.covariance, P954).major)


def _minor(i: int) -> Callable[[list[Step]], float]:
    return lambda steps: float(ellipse(steps[i].posterior.covariance, P954).minor)


def _cone(i: int) -> Callable[[list[Step]], float]:
    return lambda steps: math.degrees(
        cone_halfwidth(float(steps[i].posterior.covariance[2, 2]), P954)
    )


def _mean(i: int, entry: int) -> Callable[[list[Step]], float]:
    return lambda steps: float(steps[i].posterior.mean[entry])


def _derivative(i: int, entry: int) -> Callable[[list[Step]], float]:
    def derivative(steps: list[Step]) -> float:
        correction = steps[i].correction
        assert correction is not None
        return float(correction.H[0, entry])

    return derivative


def _predicted(i: int) -> Callable[[list[Step]], float]:
    def predicted(steps: list[Step]) -> float:
        correction = steps[i].correction
        assert correction is not None
        return float(correction.predicted[0])

    return predicted


def _worst(steps: list[Step]) -> float:
    """The largest difference of estimate and truth in any entry."""
    return max(float(np.abs(error(step.posterior, step.entry.truth)).max()) for step in steps)  # type: ignore[arg-type]


def _lap(laps: int, sign: int) -> float:
    """Radius of the ellipse after so many laps of proof-square-twice:
    the eigenvalues of its P, by hand.
    """
    P_xx, P_xy = 18 * TURN_SIGMA**2 + 2 * SIDE_SIGMA**2, 9 * TURN_SIGMA**2
    return K * math.sqrt(laps * (P_xx + sign * P_xy))


CORNER = math.radians(44)  # between beam and wall normal in proof-corner
PROOFS = (
    Proof("proof-no-noise", "largest difference of estimate and truth", 0.0, "", _worst),
    Proof("proof-turn-noise", "cone after turning 90° with 10 %", 18.0, "°", _cone(1)),
    Proof("proof-turn-noise", "cone after 120° more: 2·√(9² + 12²)", 30.0, "°", _cone(2)),
    Proof("proof-distance-noise", "ellipse after 3 m with 10 %: k·0.3", K * 0.3, " m", _major(1)),
    Proof("proof-distance-noise", "after 4 m more: k·√(0.3² + 0.4²)", K * 0.5, " m", _major(2)),
    Proof("proof-distance-noise", "its width", 0.0, " m", _minor(2)),
    Proof("proof-heading-bends", "ellipse across 6 m, heading to 5°: k·6·0.0873",
    K * 6 * math.radians(5), " m",
          _major(1)),
    Proof("proof-heading-bends", "along them, with 2 %: k·0.12", K * 0.12, " m", _minor(1)),
    Proof("proof-square-twice", "ellipse after a lap, long radius", _lap(1, 1), " m", _major(4)),
    Proof("proof-square-twice", "and short one", _lap(1, -1), " m", _minor(4)),
    Proof("proof-square-twice", "after two laps: √2 times as long", _lap(2, 1), " m", _major(8)),
    Proof("proof-across-wall", "ellipse across the wall after a beam: k·√(0.01/2)",
    K * math.sqrt(0.005), " m",
          _minor(1)),
    Proof("proof-across-wall", "after a second, equal beam: k·√(0.01/3)", K * math.sqrt(0.01 / 3),
    " m", _minor(2)),
    Proof("proof-across-wall", "along the wall it stays: k·0.1", K * 0.1, " m", _major(2)),
    Proof("proof-corner", "∂h/∂y to the left of the corner: −1/cos 44°", -1 / math.cos(CORNER), "",
    _derivative(1, 1)),
    Proof("proof-corner", "∂h/∂θ there: −4·tan 44°/cos 44°",
    -4 * math.tan(CORNER) / math.cos(CORNER), " m/rad",
          _derivative(1, 2)),
    Proof("proof-corner", "∂h/∂θ to the right of it: mirrored",
    4 * math.tan(CORNER) / math.cos(CORNER), " m/rad",
          _derivative(2, 2)),
    Proof("proof-nearest-wall", "range to the desk, not to the wall behind it", 4.0, " m",
    _predicted(1)),
    Proof("proof-nearest-wall", "past its corner, to that wall: 7/cos 20°",
    7 / math.cos(math.radians(20)), " m", _predicted(2)),
    Proof("proof-expected-wall", "x after a beam 3 m too long for the wall expected: 1 − 3/5",
    0.4, " m", _mean(1, 0)),
    Proof("proof-one-after-another", "range from where a move led: 4/cos 30°",
    4 / math.cos(math.radians(30)), " m", _predicted(2)),
    Proof("proof-one-after-another", "from where a beam led", 4.5849, " m", _predicted(3)),
    Proof("proof-two-beams", "x after a beam that is 0.1 m too long", 3.95, " m", _mean(1, 0)),
    Proof("proof-two-beams", "x after one the other way", 4.0008, " m", _mean(2, 0)),
)  # fmt: skip
