"""Panels of what should lie in a band, ±2σ if nothing else is asked for: errors, innovations; and
what was learnt of a noise, which makes the band of innovations.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, LogLocator, NullLocator, StrMethodFormatter

from ekfsim.geometry import Array
from ekfsim.models.protocols import Quantity
from ekfsim.views.curves.pens import Pen, pen, ruled
from ekfsim.views.curves.series import Series
from ekfsim.views.curves.thinning import peaks
from ekfsim.views.playback.zoom import one_two_five

REACH = 2.0
DEGREE = math.degrees(1.0)
HEADING, HALF = 2, 180.0  # the entry of a pose; half a turn, in degrees
FAR = 5.0  # times the widest band: an error that is larger would leave nothing to be seen of it
TWICE, DECADE = 2.0, 30.0  # a learnt noise's axis: at least to there; so far it has finer ticks
FINE = 1.0, 2.0, 5.0
NAMES = (("x", "x error (m)", 1.0), ("y", "y error (m)", 1.0), ("theta", "θ error (°)", DEGREE))


@dataclass(frozen=True)
class ErrorPanel:
    """The error of x, y or θ in the band that a filter believes it to lie in, of each filter."""

    entry: int  # of the pose
    reach: float = REACH  # of the band, in standard deviations to each side
    height: float = 1.0  # beside that of the other panels

    def draw(self, axes: Axes, runs: Sequence[Series]) -> None:
        """Draw it."""
        name, quantity, unit = NAMES[self.entry]
        for number, run in enumerate(runs):
            e, σ = unit * run.error[:, self.entry], unit * run.sigma[:, self.entry]
            # without a truth there is nothing to be held against the band
            σ = np.where(np.isnan(e), np.nan, σ)
            kept = peaks(np.column_stack([e, σ]))
            x, e, σ = run.abscissa[kept], e[kept], σ[kept]
            _band(axes, x, self.reach * σ, pen(number), f"{name}-{number}", len(runs) > 1)
            if self.entry == HEADING:
                x, e = _broken(x, e, HALF)
            axes.plot(
                x, e, color=pen(number).colour, ls=pen(number).dashes, lw=pen(number).width,
                gid=f"error-{name}-{number}",
            )  # fmt: skip
        errors, sigmas = (
            np.concatenate([unit * values[:, self.entry] for values in each])
            for each in ([run.error for run in runs], [run.sigma for run in runs])
        )
        linear = _scale(axes, errors, self.reach * sigmas)
        _about_zero(axes, quantity if linear is None else f"{quantity}\nlog beyond {linear:g}")


@dataclass(frozen=True)
class InnovationPanel:
    """The innovations of one quantity in their band, of each filter; used or not."""

    quantity: Quantity
    reach: float = REACH
    height: float = 1.0

    def draw(self, axes: Axes, runs: Sequence[Series]) -> None:
        """Draw it."""
        name, unit = self.quantity
        size = DEGREE if unit == "rad" else 1.0
        for number, run in enumerate(runs):
            found = run.innovations.get(self.quantity)
            if found is None:
                continue
            ν, σ = size * found.ν, size * found.σ
            kept = peaks(np.column_stack([ν, σ]))
            x = run.abscissa[found.rows[kept]]
            _band(axes, x, self.reach * σ[kept], pen(number), f"{name}-{number}", len(runs) > 1)
            axes.plot(
                x, ν[kept], color=pen(number).colour, ls="", marker=pen(number).marker, ms=2.5,
                gid=f"innovation-{name}-{number}",
            )  # fmt: skip
        unit = "°" if unit == "rad" else unit
        _about_zero(axes, f"{name}: ν ({unit})" if unit else f"{name}: ν")


@dataclass(frozen=True)
class NoisePanel:
    """How many times the told σ a filter that learns it takes a sensor's noise for, of each kind of
    reading.
    """

    height: float = 1.0

    def draw(self, axes: Axes, runs: Sequence[Series]) -> None:
        """Draw it."""
        several = len({outputs for run in runs for outputs in run.learnt}) > 1
        for number, run in enumerate(runs):
            for outputs, found in run.learnt.items():
                name = " and ".join(quantity.name for quantity in outputs)
                kept = peaks(found.ratio[:, None])
                x, ratio = run.abscissa[found.rows[kept]], found.ratio[kept]
                axes.plot(
                    x, ratio, color=pen(number).colour, ls=pen(number).dashes, lw=pen(number).width,
                    drawstyle="steps-post", gid=f"learnt-{name}-{number}",
                )  # fmt: skip
                if several:
                    axes.annotate(
                        name, (x[-1], ratio[-1]), (-3, 3), textcoords="offset points", ha="right",
                        fontsize=7, color=pen(number).colour,
                    )  # fmt: skip
        axes.set_yscale("log")
        low, high = axes.get_ylim()
        low, high = min(low, 1 / TWICE), max(high, TWICE)
        axes.set_ylim(low, high)
        axes.yaxis.set_major_locator(LogLocator(subs=FINE if high < DECADE * low else (1.0,)))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.axhline(1, color="black", lw=0.6, zorder=1)
        ruled(axes, "learnt σ / told")


def _band(axes: Axes, x: Array, half: Array, pen: Pen, name: str, edged: bool) -> None:
    """A band about zero. Several have edges, too, by which they are told apart."""
    axes.fill_between(
        x, -half, half, color=pen.colour, alpha=0.09 if edged else 0.18, lw=0, gid=f"band-{name}"
    )
    if edged:
        edge = np.concatenate([half, [np.nan], -half])
        axes.plot(
            np.concatenate([x, [np.nan], x]), edge, color=pen.colour, ls=pen.dashes, lw=0.7,
            gid=f"edge-{name}",
        )  # fmt: skip


def _broken(x: Array, e: Array, half: float) -> tuple[Array, Array]:
    """A line that breaks where an angle goes on at the other end of its range."""
    jumps = 1 + np.flatnonzero(np.abs(np.diff(e)) > half)
    return np.insert(x, jumps, np.nan), np.insert(e, jumps, np.nan)


def _scale(axes: Axes, errors: Array, band: Array) -> float | None:
    """Make the axis logarithmic beyond the band where errors lie far beyond it: from where on, or
    None where it is linear.
    """
    wide, most = (float(np.nanmax(np.abs(v), initial=0.0)) for v in (band, errors))
    if not 0 < FAR * wide < most:
        return None
    linear = one_two_five(wide)
    axes.set_yscale("symlog", linthresh=linear)
    decades = linear * 10.0 ** np.arange(1 + math.ceil(math.log10(most / linear)))
    ticks = [*(-decades[::-1]).tolist(), 0.0, *decades.tolist()]
    axes.yaxis.set_major_locator(FixedLocator(ticks))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    return linear


def _about_zero(axes: Axes, quantity: str) -> None:
    axes.axhline(0, color="black", lw=0.6, zorder=1)
    ruled(axes, quantity)
