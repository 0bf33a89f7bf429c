"""Results → CSV: a row a case, and a row a step. No date and no path: the same bytes wherever the
runs were made.
"""

import csv
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TextIO

from ekfsim.printable import cell
from ekfsim.study.plan import Plan
from ekfsim.study.results import AtStep, Result, Share
from ekfsim.study.verdict import Verdict, Word
from ekfsim.version import VERSION

FORMAT = 1  # of both tables; grows when a column changes its meaning, or goes
SHARES = ("above_50", "above_95", "above_999", "ellipse", "cone", "lost")
AT_STEP = (
    *("step", "t", "runs", "impossible", "position_rmse", "heading_rmse"),
    *(f"{name}{end}" for name in SHARES for end in ("", "_low", "_high")),
    *("ellipse_runs", "cone_runs", "nees_mean", "nees_low", "nees_high"),
)
OF_RUNS = (
    *("nees_mean_warning", "nis_mean", "nis_low", "nis_high", "nis_readings"),
    *("nis_runs", "nis_runs_above", "nis_runs_below", "nees_runs_above", "nees_runs_below"),
    *("lost_from_median", "lost_from_median_t", "worst_run", "typical_run"),
    *("verdict", "decided", "on_the_way", "from_step", "to_step", "from_t", "to_t"),
)
ORIGIN = ("seed", "gate", "guard", "reading", "set", "ekfsim", "format")


def write_summary(file: TextIO, plan: Plan, results: Iterable[Result]) -> None:
    """A row for each cell and filter."""
    table = csv.writer(file, lineterminator="\n")
    table.writerow([*plan.keys, "filter", *AT_STEP, *OF_RUNS, *_origin_columns(plan)])
    for result in results:
        table.writerow(
            [*_case(result), *_at(result.last), *_of_runs(result), *_origin(result, plan)]
        )


def write_steps(file: TextIO, plan: Plan, results: Iterable[Result]) -> None:
    """A row for each cell, filter and step."""
    table = csv.writer(file, lineterminator="\n")
    table.writerow([*plan.keys, "filter", *AT_STEP, *_origin_columns(plan)])
    for result in results:
        case, origin = _case(result), _origin(result, plan)
        table.writerows([*case, *_at(at), *origin] for at in result.steps)


def _case(result: Result) -> list[str]:
    return [*(one.value for one in result.case.values), str(cell(result.case.filter))]


def _at(at: AtStep) -> list[str]:
    shares: Sequence[Share] = (at.above_50, at.above_95, at.above_999, at.ellipse, at.cone, at.lost)
    return [
        *map(_cell, (at.step, at.t, at.runs, at.impossible, at.position_rmse, at.heading_rmse)),
        *(_cell(number) for share in shares for number in (share.value, share.low, share.high)),
        *map(_cell, (at.ellipse.of, at.cone.of, *at.nees)),
    ]


def _of_runs(result: Result) -> Iterator[str]:
    of, nis = result.tally.of, result.nis
    yield warning(result)
    yield from map(_cell, (*nis, of.nis_readings))
    yield from map(_cell, (of.nis_runs, of.nis_above, of.nis_below, of.nees_above, of.nees_below))
    yield from map(
        _cell, (result.lost_from, result.time_of(result.lost_from), result.worst, result.typical)
    )
    yield from _verdict(Verdict(result))


def _verdict(found: Verdict) -> Iterator[str]:
    """The word at the end, 1 where it is decided and 0 where it only leans; the word on the way,
    and where it holds.
    """
    end, way = found.at_end, found.on_the_way
    yield end.word.value
    yield "" if end.word is Word.NO_EVIDENCE else str(int(end.decided))
    yield "" if way.word is None else way.word.value
    first, last = (way.steps[0], way.steps[-1]) if way.steps else (None, None)
    for at in (first, last):
        yield _cell(at and at.step)
    for at in (first, last):
        yield _cell(at and at.t)


def _origin_columns(plan: Plan) -> list[str]:
    """What made the study; a swept gate or guard has its column already."""
    return [name for name in ORIGIN if name not in plan.keys]


def _origin(result: Result, plan: Plan) -> list[str]:
    scene, settings = result.case.scene, " ".join(map(str, plan.request.settings))
    made_by = scene.seed, scene.gate, scene.guard, scene.reading, settings, VERSION, FORMAT
    told = zip(ORIGIN, made_by, strict=True)
    return [_cell(value) for name, value in told if name not in plan.keys]


def warning(result: Result) -> str:
    """What stands beside every mean of NEES."""
    last = result.last
    left_out = f", {last.impossible} impossible ones left out" if last.impossible else ""
    return f"a few lost runs dominate a mean ({last.lost.runs} lost{left_out})"


def _cell(value: object) -> str:
    """A number as it stands in a table: six digits; nothing where it is undefined."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
