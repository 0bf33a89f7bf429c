"""Document 004: what is left of the NIS where R knows of the yaw error, and where it comes from."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from ekfsim.figures.album import BLACK, BLUE, GREY, ORANGE, SKY, VERMILLION, Album, labelled
from ekfsim.figures.pylon.runs import Told, as_noisy, turned_by_the_yaw_of
from ekfsim.figures.pylon.sight import INSIDE, LONG, TURNING, Innovations, inside
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.geometry import Array, Booleans
from ekfsim.localization import play
from ekfsim.systems.instruments import Pylon

LAGS = 20
RUNS = 40  # of a simulation, over which its NIS is taken
FEW = 4  # readings, which a caption can name
BEGINNING = 10  # readings: the log's inertial unit is dead in the first of them
WORST = 0.05  # share of readings that count as the worst
TRIMMED = (1 - WORST * (1 - math.log(WORST))) / (1 - WORST)  # mean of χ²₂ / 2 without them
ROBUST = 1.4826  # σ of a normal variable over its median absolute deviation


@dataclass(frozen=True)
class Tries:
    """The corrected run, and what would be if its log were otherwise."""

    told: Told
    found: Innovations
    noisier: Innovations  # were σ of the range what the ranges scatter
    sooner: Innovations  # turned by the yaw of the row before
    later: Innovations  # turned by the yaw of the row after

    @classmethod
    def of(cls, told: Told) -> "Tries":
        """Filter the run four times."""
        found = Innovations.of(told.steps())
        others = (
            as_noisy(told.entries, float(np.std(found.scatter))),
            turned_by_the_yaw_of(told.entries, -1),
            turned_by_the_yaw_of(told.entries, 1),
        )
        return cls(told, found, *(Innovations.of(told.but(entries).steps()) for entries in others))

    @property
    def across_in_turns(self) -> str:
        """The part across in turns,
        with the yaw of the row before, the same row, and the row after.
        """
        turns = self.found.turning(len(TURNING) - 2) | self.found.turning(len(TURNING) - 1)
        return ", ".join(
            _mean(each.across[turns] ** 2) for each in (self.sooner, self.found, self.later)
        )


def what_is_left(coded: Innovations, tries: Tries, album: Album) -> None:
    """Where the rest of the corrected filter's NIS comes from."""
    corrected = tries.found
    figure = album.figure(9.5, 8.4)
    (parts, shares), (turns, lags) = figure.subplots(2, 2)
    _parts(parts, corrected)
    _shares(
        shares,
        {"coded": coded, "corrected": corrected, "σ of the range as it scatters": tries.noisier},
    )
    _turns(turns, corrected)
    _lags(lags, corrected)
    figure.suptitle(
        "What is left: the innovations of the corrected filter (mean NIS per "
        f"number {corrected.mean_nis:.2f})"
    )
    along, across = np.mean(corrected.along**2), np.mean(corrected.across**2)
    slow, fast = (_mean(corrected.across[corrected.turning(k)] ** 2) for k in (0, len(TURNING) - 1))
    album.add(
        figure,
        "fig9-what-is-left",
        "What is left of the NIS once the yaw error is in R",
        f"Above left: of the mean NIS per number of {corrected.mean_nis:.2f} the part along the "
        f"line of sight is {along:.2f}, the part across it {across:.2f}; 1 each would be right. "
        f"Above right: the tail. {_share_above(corrected):.1f} % of the readings lie beyond the "
        "99.9 % quantile. The ranges themselves scatter from row to row by "
        f"{1000 * np.std(corrected.scatter):.1f} mm, whatever a filter makes of them; told that σ "
        f"in place of eq. 10's, the same filter has a mean of {tries.noisier.mean_nis:.2f} (grey). "
        f"Below left: the part across is {slow} while the cart goes straight and {fast} in the "
        f"fastest turns{_worst(corrected)}. Were yaw and range not of the same instant, the yaw of "
        f"another row would do better in turns; the part across would be {tries.across_in_turns} "
        "with that of the row before, the same row and the row after. Below right: an innovation "
        "should know nothing of the one before. Across, where a slow error of the yaw stays for "
        "many rows, the correlation from one row to the next is "
        f"{_correlation(corrected.across, 1):.2f}, along {_correlation(corrected.along, 1):.2f}. "
        "Not in the document.",
    )


def table(tries: Tries, album: Album) -> None:
    """The same in numbers."""
    told, found = tries.told, tries.found
    stated = 1000 * next(i.sigma for i in told.scene.world.told_instruments if isinstance(i, Pylon))
    usual = np.sort(found.per_number)[: round(len(found.nis) * (1 - WORST))]
    σ, robust = 1000 * np.std(found.scatter), 1000 * ROBUST * np.median(np.abs(found.scatter))
    rows = [
        ["mean NIS per number read", f"{found.mean_nis:.2f}", "1"],
        *_over_runs(told),
        ["the part along the line of sight", f"{np.mean(found.along**2):.2f}", "1"],
        ["the part across", f"{np.mean(found.across**2):.2f}", "1"],
        *(_part(f"across, turning by {name} degrees/s", found.across[is_so] ** 2, "1")
          for name, is_so in _classes(found)),
        _part(f"NIS of the first {BEGINNING} readings", found.per_number[:BEGINNING], "1"),
        _part(f"NIS of readings after a gap, {LONG} usual steps or longer",
        found.per_number[found.late], "1"),
        [f"mean NIS without the worst {100 * WORST:.0f} %", f"{usual.mean():.2f}",
        f"{TRIMMED:.2f}"],
        ["readings in the 95 % band", f"{inside(found):.1f} %", "95 %"],
        ["σ of a range, from how it scatters between its neighbours", f"{σ:.1f} mm",
        f"{stated:.1f} mm"],
        ["the same from the median, which outliers do not move", f"{robust:.1f} mm",
        f"{stated:.1f} mm"],
        ["mean NIS, were σ of the range what it scatters", f"{tries.noisier.mean_nis:.2f}", "1"],
        ["mean innovation along (a bias of range or acceleration)", f"{found.along.mean():.2f} σ",
        "0"],
        ["mean innovation across (a bias of the yaw)", f"{found.across.mean():.2f} σ", "0"],
        [f"across, turning by > {TURNING[-2]:.0f} degrees/s, by the yaw of the row before, its "
         f"own, the row after",
         tries.across_in_turns, "least by its own"],
        ["correlation of neighbours, along", f"{_correlation(found.along, 1):.2f}", "0"],
        ["correlation of neighbours, across", f"{_correlation(found.across, 1):.2f}", "0"],
    ]  # fmt: skip
    album.table(
        "what-is-left",
        "What is left, in numbers (reading corrected)",
        ["what", "measured", "right"],
        rows,
        "The part of the NIS along the line of sight is the range's, the part across it the yaw's. "
        "R takes a yaw error for a step across, while in truth it turns the reading along a "
        "circle: with the stated yaw error that alone leaves 1.1 along, as simulated runs show "
        "(with half of it 1.0).",
    )


def _part(name: str, squares: Array, right: str) -> list[str]:
    """A row of the table for some of the readings."""
    return [name, f"{_mean(squares)} ({len(squares)} readings)", right]


def _mean(squares: Array) -> str:
    return f"{squares.mean():.2f}" if len(squares) else "unknown"


def _over_runs(told: Told) -> list[list[str]]:
    """What many simulated runs say, of which a log has but one."""
    if told.scene.log is not None:
        return []
    nis = [
        step.correction.nis
        for step in play(told.scene, np.arange(RUNS))
        if step.correction is not None
    ]
    return [[f"mean NIS over {RUNS} simulated runs", f"{np.mean(nis) / 2:.2f}", "1"]]


def _parts(axes: Axes, found: Innovations) -> None:
    labelled(axes, "across the line of sight (σ)", "along the line of sight (σ)")
    fast = found.turning(len(TURNING) - 1)
    axes.plot(found.across[~fast], found.along[~fast], ".", ms=3, color=BLUE, label="readings")
    axes.plot(
        found.across[fast],
        found.along[fast],
        ".",
        ms=5,
        color=ORANGE,
        label=f"turning > {TURNING[-1]:.0f} °/s",
    )
    turn = np.linspace(0, 2 * np.pi, 100)
    radius = np.sqrt(quantile(INSIDE, 2))
    axes.plot(
        radius * np.cos(turn),
        radius * np.sin(turn),
        color=BLACK,
        lw=1,
        label="95 % of a right filter's",
    )
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, fontsize=7)
    axes.set_title("Innovations, normalised", fontsize=10)


def _shares(axes: Axes, all_: dict[str, Innovations]) -> None:
    labelled(axes, "NIS per number read", "share of readings above it")
    for (name, found), color in zip(all_.items(), (VERMILLION, BLUE, GREY), strict=True):
        values = np.sort(found.per_number)
        share = 1 - np.arange(len(values)) / len(values)
        axes.step(
            values,
            share,
            where="pre",
            color=color,
            lw=1.4,
            label=f"{name}: mean {found.mean_nis:.2f}",
        )
    values = np.geomspace(1e-2, -np.log(0.5 / len(values)), 200)
    axes.plot(values, np.exp(-values), "--", color=BLACK, lw=1, label="of a right filter: mean 1")
    axes.set(xscale="log", yscale="log", xlim=(1e-2, None), ylim=(1e-5, None))
    axes.legend(loc="lower left", fontsize=8)
    axes.set_title("How many readings have a large NIS", fontsize=10)


def _turns(axes: Axes, found: Innovations) -> None:
    labelled(axes, "turn rate (degrees/s)", "mean square (σ²)")
    classes = [(name, is_so) for name, is_so in _classes(found) if is_so.any()]
    places = np.arange(len(classes))
    for values, color, name, side in (
        (found.along, BLUE, "along", -0.2),
        (found.across, VERMILLION, "across", 0.2),
    ):
        heights = [np.mean(values[is_so] ** 2) for _, is_so in classes]
        axes.bar(places + side, heights, 0.4, color=color, label=name)
    axes.axhline(1, color=BLACK, lw=1, ls="--", label="1: right")
    axes.set_xticks(
        places,
        [f"{name}\n{np.count_nonzero(is_so)} readings" for name, is_so in classes],
        fontsize=8,
    )
    axes.legend(loc="best", fontsize=8)
    axes.set_title("By how fast the cart turns", fontsize=10)


def _lags(axes: Axes, found: Innovations) -> None:
    labelled(axes, "rows between two innovations", "correlation")
    lags = np.arange(1, LAGS + 1)
    bound = 1.96 / np.sqrt(len(found.t))
    axes.axhspan(-bound, bound, color=SKY, alpha=0.25, lw=0, label="95 % of a right filter's")
    for values, color, name in ((found.along, BLUE, "along"), (found.across, VERMILLION, "across")):
        axes.plot(
            lags,
            [_correlation(values, int(lag)) for lag in lags],
            "o-",
            ms=3,
            lw=1,
            color=color,
            label=name,
        )
    axes.axhline(0, color=BLACK, lw=0.6)
    axes.set_ylim(top=1)
    axes.set_xticks(range(0, LAGS + 1, 5))
    axes.legend(loc="best", fontsize=8)
    axes.set_title("What an innovation knows of later ones", fontsize=10)


def _classes(found: Innovations) -> list[tuple[str, Booleans]]:
    names = [f"{slow:.0f} to {fast:.0f}" for slow, fast in pairwise(TURNING)]
    return [(name, found.turning(k)) for k, name in enumerate([*names, f"> {TURNING[-1]:.0f}"])]


def _worst(found: Innovations) -> str:
    """Which few readings make most of what is left across in the fastest turns."""
    fast = found.turning(len(TURNING) - 1)
    squares, t = found.across[fast] ** 2, found.t[fast]
    worst = np.argsort(squares)[-FEW:]
    if len(squares) <= FEW:
        return ""
    when = ", ".join(f"{second:.1f}" for second in sorted(t[worst]))
    return (
        f", {100 * squares[worst].sum() / squares.sum():.0f} % of that in {FEW} readings (at "
        f"{when} s)"
    )


def _correlation(values: Array, lag: int) -> float:
    centred = values - values.mean()
    return float(np.mean(centred[lag:] * centred[:-lag]) / np.mean(centred**2))


def _share_above(found: Innovations) -> float:
    """The share of readings beyond the 99.9 % quantile, in %."""
    return 100 * float(np.mean(found.nis > quantile(0.999, 2)))
