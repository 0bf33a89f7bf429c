"""Axes of a map: metres, each number told whole, however far from the origin of its grid."""

from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

FAR = 1e5  # m; from there on a number is so long that few of them stand side by side
FEW = 4


def in_metres(axes: Axes) -> None:
    """Label both axes, whose limits are set; no number is told as a difference to another."""
    axes.set(xlabel="x (m)", ylabel="y (m)")
    if max(map(abs, axes.get_xlim())) >= FAR:
        axes.xaxis.set_major_locator(MaxNLocator(FEW))
    if max(map(abs, axes.get_ylim())) >= FAR:
        axes.tick_params(axis="y", labelrotation=90)
        axes.yaxis.set_major_locator(MaxNLocator(FEW))
    axes.ticklabel_format(useOffset=False, style="plain")
