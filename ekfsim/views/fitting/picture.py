"""NIS and whiteness of a log before and after its noises were fitted."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.fitting.trial import Judged, Trial
from ekfsim.version import VERSION
from ekfsim.views.study.sheet import GREY, PENS, sheet

USUAL = 0.95
SMOOTH = 20  # so many stretches of a log have a mean NIS each
FINE = "#DDDDDD"


def told(trial: Trial) -> str:
    """What made the picture, in a line."""
    scene = trial.scene
    facts = [
        f"commands {scene.commands_source}",
        f"log {scene.log_source}",
        f"filter {scene.filter}",
    ]
    return ", ".join([f"ekfsim {VERSION}", *facts])


def picture(trial: Trial) -> Figure:
    """A column before and a column after: NIS over the log, lags of the half that was held back."""
    figure = sheet(10.0, 5.6, "Innovations as told, and as fitted to the first half", told(trial))
    grid = figure.subplots(2, 2, sharey="row")
    for column, (name, half) in enumerate((("as told", trial.before), ("as fitted", trial.after))):
        draw_nis(grid[0, column], half, trial)
        grid[0, column].set_title(f"{name}: NIS {half.mean:.3g} on the second half", fontsize=10)
        draw_lags(grid[1, column], half)
        grid[1, column].set_title(f"second half: innovations are {half.found.word}", fontsize=10)
    grid[0, 0].set_ylabel("NIS per number read")
    grid[1, 0].set_ylabel("autocorrelation around 0")
    return figure


def draw_nis(axes: Axes, half: Judged, trial: Trial) -> None:
    """Each reading's NIS, the mean of stretches, and where the second half begins."""
    at, nis = np.array(half.at), np.maximum(half.nis, 1e-3)
    axes.plot(at, nis, ".", ms=2.5, color=PENS[0].colour, alpha=0.6)
    for some in np.array_split(np.arange(len(at)), min(SMOOTH, max(len(at) // 5, 1))):
        mean = float(np.mean(nis[some]))
        axes.plot(at[some][[0, -1]], [mean, mean], color=PENS[1].colour, lw=2)
    axes.axhline(1.0, color=GREY, lw=0.9)
    axes.axhline(quantile(USUAL, 1), color=GREY, lw=0.9, ls=":")
    axes.axvspan(trial.half, float(at[-1]), color=GREY, alpha=0.1, lw=0)
    axes.set(yscale="log", xlabel="t (s)" if not trial.scene.commanded else "step")
    axes.grid(True, color=FINE, lw=0.6)


def draw_lags(axes: Axes, half: Judged) -> None:
    """Lags 1 to 5 of each sensor, within what one in twenty exceeds where all is right."""
    sensors = half.found.sensors
    for number, one in enumerate(sensors):
        x = np.arange(1, len(one.lags) + 1) + 0.8 * ((number + 0.5) / len(sensors) - 0.5)
        pen = PENS[number % len(PENS)]
        axes.bar(x, np.nan_to_num(one.lags), 0.7 / len(sensors), color=pen.colour, label=one.sensor)
        reach = 1.96 / np.sqrt(max(float(one.numbers), 1.0))
        for side in (reach, -reach):
            axes.axhline(side, color=pen.colour, lw=0.9, ls=":")
    axes.axhline(0, color=GREY, lw=0.9)
    axes.set(xlabel="lag (readings of the sensor)", ylim=(-1, 1))
    axes.legend(fontsize=8, frameon=False)
