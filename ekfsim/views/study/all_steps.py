"""What many runs find over all their steps, for a smoother and its filter are one at the last."""

import math
from collections.abc import Sequence

from ekfsim.filters.place import is_smoothed
from ekfsim.study.plan import Plan
from ekfsim.study.results import Result, Share
from ekfsim.views.words.text_table import aligned, folded

HEAD = "filter", "position", "heading", "> 50 %", "> 95 %", "> 99.9 %", "ellipse", "cone"


def over_all_steps(plan: Plan, results: Sequence[Result], width: int | None) -> list[str]:
    """A table of each case over all steps that are told of, where any of them is smoothed."""
    if not any(is_smoothed(result.case.scene.filter) for result in results):
        return []
    rows = [[*plan.keys, *HEAD], *map(_row, results)]
    return [
        *folded("Over all steps (50 % above the χ² median is right, 5 % above 95 %):", width),
        *aligned(rows, len(plan.keys) + 1, width),
    ]


def _row(result: Result) -> list[str]:
    at, runs = result.tally.at, result.tally.runs
    instants = runs * len(result.tally.steps)
    shares = (
        (at.above_50, at.judged), (at.above_95, at.judged), (at.above_999, at.judged),
        (at.in_ellipse, at.ellipse_runs), (at.in_cone, at.cone_runs),
    )  # fmt: skip
    return [
        *(one.value for one in result.case.values),
        result.case.filter,
        f"{math.sqrt(float(at.position_square.sum()) / instants):.3g}",
        f"{math.degrees(math.sqrt(float(at.heading_square.sum()) / instants)):.3g}",
        *(_percent(Share(int(some.sum()), int(of.sum()))) for some, of in shares),
    ]


def _percent(share: Share) -> str:
    return "-" if math.isnan(share.value) else f"{100 * share.value:.1f}"
