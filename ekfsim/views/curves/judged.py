"""Panels of what χ² judges: NIS and NEES with their bounds."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.geometry import Array, Integers
from ekfsim.views.curves.pens import pen, ruled
from ekfsim.views.curves.series import Series, bound
from ekfsim.views.curves.thinning import peaks
from ekfsim.views.picture.artists import Dashes

USUAL = 0.95
# what is drawn of BOUNDS: where one in twenty lies beyond, and where a run is called lost
DRAWN: dict[float, Dashes] = {USUAL: ":", LOST: "-."}
LINEAR = 4.0  # times the last bound: up to there an axis is linear
LEAST = 1e-2  # of a logarithmic axis; what is less lies at its edge
BOUND = "#333333"
FEW, LARGE, SMALL = 120, 4.5, 2.5  # readings of which each has a larger dot, in points


@dataclass(frozen=True)
class NisPanel:
    """The NIS of each reading that was used; what was refused is marked (marks.py)."""

    height: float = 1.25

    def draw(self, axes: Axes, runs: Sequence[Series]) -> None:
        """Draw it."""
        scale(axes, [run.nis for run in runs], [run.nis_dof for run in runs])
        for number, run in enumerate(runs):
            rows = np.flatnonzero(run.used & ~np.isnan(run.nis))
            rows = rows[peaks(run.nis[rows, None])]
            axes.plot(
                run.abscissa[rows], lifted(axes, run.nis[rows]), color=pen(number).colour,
                ls="", marker=pen(number).marker, ms=SMALL if len(rows) > FEW else LARGE,
                clip_on=False, gid=f"nis-{number}",
            )  # fmt: skip
        freedoms = np.unique(np.concatenate([run.nis_dof[run.read] for run in runs]))
        for probability, dof in ((p, int(n)) for p in DRAWN for n in freedoms):
            at = quantile(probability, dof)
            axes.axhline(
                at, color=BOUND, lw=0.9, ls=DRAWN[probability], gid=f"bound-{probability}-{dof}"
            )
            if len(freedoms) > 1:  # whose bound it is
                axes.annotate(
                    str(dof), (1, at), (3, 0), xycoords=axes.get_yaxis_transform(),
                    textcoords="offset points", va="center", fontsize=7, color=BOUND,
                )  # fmt: skip
        ruled(axes, f"NIS ({' or '.join(map(str, freedoms))} dof)")


@dataclass(frozen=True)
class NeesPanel:
    """The NEES after each step. Its bounds change where P gains or loses a rank."""

    height: float = 1.25

    def draw(self, axes: Axes, runs: Sequence[Series]) -> None:
        """Draw it."""
        scale(axes, [run.nees for run in runs], [run.nees_dof for run in runs])
        for number, run in enumerate(runs):
            kept = peaks(run.nees[:, None])
            axes.plot(
                run.abscissa[kept], lifted(axes, run.nees[kept]), color=pen(number).colour,
                ls=pen(number).dashes, lw=pen(number).width, gid=f"nees-{number}",
            )  # fmt: skip
        for number, run in _of_their_own(runs):
            colour = BOUND if number == 0 else pen(number).colour
            for probability, dashes in DRAWN.items():
                axes.plot(
                    *_stairs(run.abscissa, bound(probability, run.nees_dof)), color=colour,
                    lw=0.9, ls=dashes, gid=f"bound-{probability}-{number}",
                )  # fmt: skip
        ruled(axes, "NEES")


def scale(axes: Axes, values: Sequence[Array], dofs: Sequence[Integers]) -> None:
    """Make the axis logarithmic where some value lies far beyond its bounds, linear elsewhere."""
    most = max((float(np.nanmax(v, initial=0.0)) for v in values), default=0.0)
    last = quantile(LOST, max((int(dof.max(initial=0)) for dof in dofs), default=0))
    if most > LINEAR * last:
        axes.set_yscale("log")
        axes.set_ylim(LEAST, most * 3)
    else:
        axes.set_ylim(0, 1.12 * max(most, last, 1.0))


def lifted(axes: Axes, values: Array) -> Array:
    """What a logarithmic axis cannot show, on its edge."""
    return np.maximum(values, LEAST) if axes.get_yscale() == "log" else values


def _of_their_own(runs: Sequence[Series]) -> Iterator[tuple[int, Series]]:
    """The first filter, and those whose covariances have another rank somewhere."""
    for number, run in enumerate(runs):
        if number == 0 or not np.array_equal(run.nees_dof, runs[0].nees_dof):
            yield number, run


def _stairs(x: Array, y: Array) -> tuple[Array, Array]:
    """The corners of a line that is level but for some steps: the ends of each level."""
    changes = np.flatnonzero((y[1:] != y[:-1]) & ~(np.isnan(y[1:]) & np.isnan(y[:-1])))
    kept = np.unique(np.concatenate([[0], changes, changes + 1, [len(y) - 1]]))
    return x[kept], y[kept]
