"""Document 001, figure 2: a polar reading in Cartesian coordinates,
linearised and by the unscented transform.
"""

import math
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes

from ekfsim.figures.album import BLACK, BLUE, GREY, VERMILLION, Album, labelled
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.arithmetic.unscented import sigma_points, unscented_transform, weights
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import outline
from ekfsim.models.sensors.polar import cartesian, cartesian_jacobian, cartesian_moments
from ekfsim.scene import Scene
from ekfsim.simulation.bench import gaussian

READING = np.array([1.0, math.pi / 2])  # m, rad
RANGE_SIGMA, BEARING_SIGMA = 0.02, math.radians(15)
P_READING = np.diag([RANGE_SIGMA**2, BEARING_SIGMA**2])
SAMPLES, SHOWN = 1_000_000, 1500
ONE_SIGMA = 1 - math.exp(-0.5)  # the probability of the ellipse of one standard deviation
CAPTION = """
A range of 1 m ± 2 cm and a bearing of 90° ± 15° (standard deviations) of a beacon at (0, 1). Grey:
{shown} of {samples} readings, a banana. Ellipses reach one standard deviation. The true mean lies
at (0, {exact:.4f}): bearings that are wrong to either side pull it down. Left: the linearised mean
stays at (0, 1), {off:.1f} true standard deviations of y too high, and its ellipse is {flat:.1f}
times too flat. Right: the five sigma points of the unscented transform (κ = 1) lie on the banana,
and their mean and ellipse hide the true ones: they differ by {slip:.1g} m and by {slack:.0f} % of
the smaller variance.

Compared with the print: the same banana and the same two means. The document takes (0, 1) for the
real mean and says that the unscented mean coincides with it and its covariance is circular. The
beacon stands at (0, 1); the mean of its readings does not, and that is what the unscented mean
coincides with. Its ellipse is {round:.0f} times wider than high; circular it looks only with axes
of different scales. And sigma points do not "capture the true mean and covariance of any nonlinear
system": here the variance of y is {slack:.0f} % off. They are those of eq. 14.
"""
TABLE = """
Moments of (x, y) in m and m². κ = 1 (n + κ = 3, Julier's choice for a Gaussian) is nearest to the
exact ones in every column; κ = 0 counts the mean itself for nothing and misses the variance of y by
{third:.0f} %; the scaled transform, whose points lie within two thousandths of a standard
deviation, has a second-order mean and the linearised variance of x. What is left of the Monte Carlo
row's difference is chance. The document prints no numbers.
"""


class Moments(NamedTuple):
    """What a way of computing them says of the mean (2,) in m and the covariance (2, 2) in m²."""

    method: str
    mean: Array
    covariance: Array


def linearised() -> Moments:
    """ȳ = f(x̄)      P_yy = ∇f P ∇fᵀ          eqs 18, 19"""
    F = cartesian_jacobian(READING)
    return Moments("linearised (EKF)", cartesian(READING), F @ P_READING @ F.T)


def unscented(method: str, alpha: float = 1.0, beta: float = 0.0, kappa: float = 1.0) -> Moments:
    """By the transform that the filter `ukf` uses."""
    there = unscented_transform(READING, P_READING, cartesian, weights(2, alpha, beta, kappa))
    return Moments(method, there.mean, there.covariance)


def all_moments(samples: Array) -> list[Moments]:
    """The rows of the table, the exact ones first. samples : (N, 2) m"""
    return [
        Moments("exact", *cartesian_moments(READING, RANGE_SIGMA, BEARING_SIGMA)),
        linearised(),
        unscented("unscented, κ = 1"),
        unscented("unscented, κ = 0", kappa=0.0),
        unscented("scaled, α = 0.001, β = 2, κ = 0", 1e-3, 2.0, 0.0),
        Moments(f"Monte Carlo, {len(samples):,} readings", samples.mean(axis=0), np.cov(samples.T)),
    ]


def draw_polar(scene: Scene, album: Album) -> None:
    """Figure 2 and the table of moments."""
    many = np.broadcast_to(READING, (SAMPLES, 2))
    samples = cartesian(gaussian(many, P_READING, np.random.default_rng([scene.seed, 2])))
    moments = all_moments(samples)
    exact, line, bent, unweighted = moments[:4]
    figure = album.figure(9.6, 3.4)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    for axes in (left, right):
        labelled(axes, "x (m)", "y (m)" if axes is left else "").set(
            aspect="equal", xlim=(-0.86, 0.86), ylim=(0.38, 1.15)
        )
        axes.plot(
            *samples[:SHOWN].T, ".", color=GREY, ms=2, alpha=0.35, label="readings", rasterized=True
        )
        _moments(axes, exact, BLACK, "--", "o", "true mean, 1σ ellipse")
    _moments(left, line, VERMILLION, "-", "s", "linearised (eq. 19)")
    _moments(right, bent, BLUE, "-", "D", "unscented, κ = 1")
    points = cartesian(sigma_points(READING, square_root(P_READING), weights(2, kappa=1.0).spread))
    right.plot(*points.T, "x", color=BLUE, ms=8, mew=1.8, label="sigma points (eqs 14, 15)")
    left.set_title("Linearised", fontsize=10)
    right.set_title("Unscented transform", fontsize=10)
    for axes in (left, right):
        axes.legend(loc="lower center", fontsize=7.5, ncols=2, markerscale=1.0)
    σ = np.sqrt(np.diagonal(exact.covariance))
    album.add(
        figure, "fig2-unscented", "Figure 2: linearised and unscented transform of a polar reading",
        CAPTION.format(
            shown=f"{SHOWN:,}", samples=f"{SAMPLES:,}", exact=exact.mean[1],
            off=abs(line.mean[1] - exact.mean[1]) / σ[1], flat=σ[1] / np.sqrt(line.covariance[1,
            1]),
            slip=np.hypot(*(bent.mean - exact.mean)),
            slack=100 * abs(bent.covariance[1, 1] / exact.covariance[1, 1] - 1),
            round=σ[0] / σ[1], wide=σ[0] ** 2 / σ[1] ** 2,
        ),
    )  # fmt: skip
    header = ("method", "mean x (m)", "mean y (m)", "var x (m²)", "var y (m²)")
    rows = []
    for m in moments:
        # cos 90° is no 0, and must not be −0
        numbers = (*m.mean.round(9) + 0.0, *np.diagonal(m.covariance))
        rows.append((m.method, *(f"{value:.6f}" for value in numbers)))
    third = 100 * abs(unweighted.covariance[1, 1] / exact.covariance[1, 1] - 1)
    album.table("moments", "Moments of the polar reading", header, rows, TABLE.format(third=third))


def _moments(axes: Axes, m: Moments, color: str, style: str, marker: str, label: str) -> None:
    """A mean and its ellipse."""
    axes.plot(*outline(m.mean, m.covariance, ONE_SIGMA).T, style, color=color, lw=1.8, label=label)
    axes.plot(*m.mean, marker, color=color, ms=6, mec="white", mew=0.8)
