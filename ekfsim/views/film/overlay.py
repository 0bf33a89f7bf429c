"""A plan and the walls that were made of it, over each other."""

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.transforms import Affine2D

from ekfsim.files.maps.plan import Plan, Scan, Start
from ekfsim.geometry import Array
from ekfsim.views.film.still import save
from ekfsim.views.picture.artists import BLUE, GREEN, ORANGE, VERMILLION, closed
from ekfsim.views.picture.written.lettering import drawable, shortened

LONGER, SHORTER, NARROWEST = 14.0, 1.0, 5.0  # in: the longer side, room for the title, the shorter
EDGE = 0.03  # of the plan, around it
TITLE = 110  # letters
DPI = 150


def draw(plan: Plan, start: Start, target: Path, source: str, force: bool = False) -> None:
    """Write the picture whole or not at all. Raises UsageError as `save` does."""
    low, high = _box(plan)
    size = np.maximum(high - low, 1e-3) * (1 + 2 * EDGE)
    inches = np.maximum(LONGER * size / size.max(), NARROWEST)
    figure = Figure(figsize=(inches[0], inches[1] + SHORTER), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    middle = (low + high) / 2
    axes.set(
        xlim=(middle[0] - size[0] / 2, middle[0] + size[0] / 2),
        ylim=(middle[1] - size[1] / 2, middle[1] + size[1] / 2),
        aspect="equal", xlabel="x (m)", ylabel="y (m)",
    )  # fmt: skip
    axes.set_title(shortened(drawable(f"{plan.name}: {source}"), TITLE), fontsize=9)
    if plan.scan is not None:
        _lay_out(axes, plan.scan)
    _walls(axes, plan)
    _robot(axes, start, 0.012 * float(size.max()))
    figure.legend(loc="outside lower center", fontsize=8, ncols=6, frameon=False)
    save(figure, target, plan.name, source, force)


def _box(plan: Plan) -> tuple[Array, Array]:
    """The corners of the box around all that stands in a plan."""
    points = [
        *([] if plan.boundary is None else [plan.boundary]),
        *(one.points for one in plan.outlines),
        *(line.points for line in plan.lines),
        *(np.array([[c.x - c.radius, c.y - c.radius], [c.x + c.radius, c.y + c.radius]])
          for c in plan.circles),
        *(np.array([[mark.x, mark.y]]) for mark in plan.landmarks),
    ]  # fmt: skip
    all_points = np.concatenate(points) if points else np.array([[-1.0, -1.0], [1.0, 1.0]])
    return all_points.min(axis=0), all_points.max(axis=0)


def _lay_out(axes: Axes, scan: Scan) -> None:
    """The picture that was read, where it lies."""
    rows, columns = scan.grey.shape
    x, y, yaw = scan.origin
    lying = Affine2D().scale(scan.resolution).rotate(math.radians(yaw)).translate(x, y)
    axes.imshow(
        scan.grey, cmap="gray", vmin=0, vmax=1, interpolation="nearest",
        extent=(0, columns, 0, rows), transform=lying + axes.transData, gid="scan",
    )  # fmt: skip


def _walls(axes: Axes, plan: Plan) -> None:
    """Everything that a beam meets, and landmarks."""
    rings = {
        "boundary": [] if plan.boundary is None else [closed(plan.boundary)],
        "obstacle": [closed(ring) for one in plan.outlines for ring in (one.points, *one.holes)],
        "wall": [line.points for line in plan.lines],
    }
    for (label, lines), colour in zip(rings.items(), (VERMILLION, BLUE, ORANGE), strict=True):
        if lines:
            axes.add_collection(
                LineCollection(lines, colors=colour, linewidths=1.1, label=label, gid=label),
                autolim=False,
            )
    for one in plan.circles:
        axes.add_patch(Circle((one.x, one.y), one.radius, fill=False, ec=BLUE, lw=1.1))
    if plan.landmarks:
        x, y = zip(*((mark.x, mark.y) for mark in plan.landmarks), strict=True)
        axes.plot(x, y, "^", color=GREEN, ms=6, label="landmark")


def _robot(axes: Axes, start: Start, size: float) -> None:
    """Where it starts."""
    x, y, heading = start[0], start[1], math.radians(start[2])
    axes.add_patch(Circle((x, y), size, fc=GREEN, ec="black", lw=0.8, zorder=3, label="start"))
    ahead = 1.8 * size * np.array([math.cos(heading), math.sin(heading)])
    axes.plot([x, x + ahead[0]], [y, y + ahead[1]], color="black", lw=1.2, zorder=3)
