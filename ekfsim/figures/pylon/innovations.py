"""Document 004: whether its filter may be believed,
and what is left of its NIS where R knows of the yaw error.
"""

import math

import numpy as np

from ekfsim.figures.album import BLACK, BLUE, SKY, VERMILLION, Album, labelled
from ekfsim.figures.pylon.runs import Runs
from ekfsim.figures.pylon.sight import INSIDE, Innovations, inside
from ekfsim.figures.pylon.what_is_left import Tries, table, what_is_left
from ekfsim.filters.arithmetic.chi_square import band


def innovations(runs: Runs, album: Album) -> None:
    """The figures and the table of what the innovations say."""
    coded, tries = Innovations.of(runs.told["coded"].steps()), Tries.of(runs.told["corrected"])
    over_time(coded, tries.found, album)
    what_is_left(coded, tries, album)
    table(tries, album)


def over_time(coded: Innovations, corrected: Innovations, album: Album) -> None:
    """NIS of every reading, with and without the yaw error in R."""
    low, high = band(INSIDE, 2)
    figure = album.figure(8.5, 4.6)
    axes = labelled(figure.add_subplot(), "time (s)", "NIS per number read")
    axes.axhspan(
        low / 2,
        high / 2,
        color=SKY,
        alpha=0.25,
        lw=0,
        label=f"95 % band: {low / 2:.2g} to {high / 2:.3g}",
    )
    axes.plot(
        coded.t,
        coded.per_number,
        ".",
        ms=4,
        color=VERMILLION,
        label=f"coded: mean {coded.mean_nis:.1f}",
    )
    axes.plot(
        corrected.t,
        corrected.per_number,
        ".",
        ms=4,
        color=BLUE,
        label=f"corrected: mean {corrected.mean_nis:.2f}",
    )
    axes.axhline(1, color=BLACK, lw=0.8, ls="--", label="1: what is right on average")
    axes.set_yscale("log")
    seen = np.concatenate([coded.per_number, corrected.per_number])
    axes.set_ylim(bottom=min(1e-2, 0.7 * float(seen[seen > 0].min(initial=1.0))))
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), fontsize=8, ncols=4)
    axes.set_title("NIS with and without the yaw error in R")
    album.add(
        figure,
        "fig8-nis",
        "NIS over time, with and without the yaw error times the lever arm in R",
        f"Per number read {coded.mean_nis:.1f} on average with the authors' R, where 1 is right: "
        f"an innovation is some {math.sqrt(coded.mean_nis):.0f} times as large as that filter "
        "thinks possible. The reading is turned by the yaw before it is used, and so R must hold "
        "σ_θ² J Jᵀ, J = (−h_y, h_x), besides eq. 10 (the authors suspect as much in their "
        f"conclusion). With it the mean is {corrected.mean_nis:.2f}, the median "
        f"{np.median(corrected.per_number):.2f} (0.69 is right), and {inside(corrected):.0f} % of "
        f"the readings lie in the 95 % band, against {inside(coded):.0f} % without. Not in the "
        "document. What is left: the next figure.",
    )
