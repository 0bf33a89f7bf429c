"""Document 003: the errors in numbers, of one run and over many."""

import numpy as np

from ekfsim.figures.album import Album
from ekfsim.figures.gnss.runs import ManyRuns, Runs, length, pose_error
from ekfsim.figures.over_runs import spread
from ekfsim.figures.track import Track, rmse
from ekfsim.geometry import Array


def table(runs: Runs, album: Album) -> None:
    """All errors in numbers."""
    truth, raw = runs.right.truth, rmse(length(runs.fixes.error))

    def row(name: str, error: Array, φ: float | None, nis: float | None = None) -> list[str]:
        position = length(error[:, :2])
        numbers = [rmse(error[:, 0]), rmse(error[:, 1]), rmse(position), float(np.nanmax(position))]
        told = ["-" if number is None else f"{number:.4f}" for number in (*numbers, φ)]
        return [name, *told, f"{rmse(position) / raw:.2f}", "-" if nis is None else f"{nis:.2f}"]

    def filtered(name: str, track: Track) -> list[str]:
        return row(name, pose_error(track.pose, track.truth), rmse(track.heading_error), track.nis)

    wheels = pose_error(runs.wheels, truth)
    rows = [
        row("raw GNSS, at its own instants", runs.fixes.error, None),
        row("wheels alone", wheels, rmse(wheels[:, 2])),
        filtered("the document's filter, written with dt (printed, corrected)", runs.right),
        filtered("the authors' recipe, a fix at every row (coded)", runs.recipe),
        filtered("the authors' recipe, at the recorded fixes alone", runs.sparse),
    ]
    header = ["method", "RMSE x (m)", "RMSE y (m)", "RMSE position (m)", "largest (m)",
    "RMSE φ (rad)", "of raw GNSS",
              "mean NIS per number"]  # fmt: skip
    cost = rmse(runs.recipe.position_error) / rmse(runs.right.position_error)
    album.table(
        "errors",
        "Errors in numbers, and what each reading costs",
        header,
        rows,
        f"Errors at all {len(runs.right.t)} instants of the wheels; a NIS of 1 per number read is "
        "what a filter that knows its own uncertainty has on average. 'Of raw GNSS' above 1 is a "
        "filter that makes its data worse. To follow the recipe (--reading coded) costs "
        f"{times(cost)} the position error of the filter with dt; the equations as printed are "
        "right, so that reading costs nothing.",
    )


def table_over_runs(many: ManyRuns, album: Album) -> None:
    """The same over many simulated runs:
    what is said of the filters, none of them alone decides.
    """
    right, recipe, fixes = many.right, many.recipe, many.fixes
    rows = [
        ["raw GNSS, at its own instants", spread(fixes), "-", "1", "-"],
        ["wheels alone", spread(right.reckoned_position), spread(right.reckoned_heading),
         spread(right.reckoned_position / fixes), "-"],
        ["the document's filter, written with dt", spread(right.position), spread(right.heading),
         spread(right.position / fixes), spread(right.nis)],
        ["the authors' recipe (coded)", spread(recipe.position), spread(recipe.heading),
         spread(recipe.position / fixes), spread(recipe.nis)],
    ]  # fmt: skip
    worse = int(np.count_nonzero(recipe.heading > right.reckoned_heading))
    album.table(
        "errors-over-runs",
        f"The same over {len(fixes)} simulated runs",
        ["method", "RMSE position (m)", "RMSE φ (rad)", "of raw GNSS", "mean NIS per number"],
        rows,
        "The mean of the runs, and from the least to the most of them. The filter with dt has "
        f"{spread(right.position / fixes, 2)} times the error of the raw fixes, the recipe "
        f"{spread(recipe.position / fixes, 2)} times. The recipe's heading is worse than that of "
        f"the wheels alone in {worse} runs.",
    )


def times(factor: float) -> str:
    """A factor in words, without decimals where it is large."""
    return f"{factor:.2g} times" if factor < 10 else f"{factor:.0f} times"
