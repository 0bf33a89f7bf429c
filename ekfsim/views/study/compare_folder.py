"""The folder of a comparison: a table, a picture, and all that is needed to repeat it."""

import csv
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TextIO

from ekfsim.files.results.writing import whole_folder
from ekfsim.files.scenes.load_study import FILTER
from ekfsim.study.code import Copies
from ekfsim.study.comparison import Comparison
from ekfsim.study.pairs import Pairs
from ekfsim.study.plan import as_option, way_of
from ekfsim.version import VERSION
from ekfsim.views.study.compare_picture import draw_comparison
from ekfsim.views.study.compare_words import measures, settings
from ekfsim.views.study.folder import (
    copies_in,
    first_lines,
    in_yaml,
    last_lines,
    write_to_repeat,
    written,
)

FILES = ("compare.csv", "compare.png", "compare.yaml", "commands.yaml", "world.yaml")
FORMAT = 1  # of compare.csv; grows when a column changes its meaning, or goes
HEAD = ("measure", "unit", "runs", "a", "b", "difference", "low", "high", "only_a", "only_b")
ORIGIN = ("a_sets", "b_sets", "seed", "ekfsim", "format")


def write_comparison(comparison: Comparison, found: Pairs, out: Path, force: bool) -> None:
    """Write the folder, whole or not at all."""
    copies = Copies.of(comparison.filters)
    with whole_folder(out, *FILES, *copies_in(out, comparison.filters), force=force) as folder:
        with (folder / "compare.csv").open("w", newline="", encoding="utf-8") as file:
            write_table(file, comparison, found)
        draw_comparison(comparison, found, folder / "compare.png")
        told = lines(comparison, copies.names)
        write_to_repeat(comparison.request, folder / "compare.yaml", told, copies.files)


def write_table(file: TextIO, comparison: Comparison, found: Pairs) -> None:
    """A row for each measure, in SI units; no date and no path."""
    table = csv.writer(file, lineterminator="\n")
    table.writerow([*HEAD, *ORIGIN])
    sides = [settings(plan, comparison) for plan in (comparison.a, comparison.b)]
    for measure in measures(found):
        numbers = ("" if math.isnan(number) else f"{number:.6g}" for number in measure.found)
        alone = ("" if runs is None else runs for runs in (measure.a_alone, measure.b_alone))
        origin = (*sides, comparison.a.seed, VERSION, FORMAT)
        table.writerow([measure.name, measure.unit, measure.runs, *numbers, *alone, *origin])


def lines(comparison: Comparison, names: Mapping[str, str]) -> Iterator[str]:
    """A file of this comparison; `names` is how it names its filters."""
    request = comparison.request
    plain = as_option(way_of(request))
    yield f"# `ekfsim compare compare.yaml{plain}` makes this comparison again."
    yield from first_lines(request, comparison.a.seed)
    for name, plan, told in (("a", comparison.a, request.a), ("b", comparison.b, request.b)):
        yield f"{name}:"
        yield f"  {FILTER}: {in_yaml(names[plan.cases[0].scene.filter])}"
        yield from (f"  {one.key}: {written(one)}" for one in told if one.key != FILTER)
    yield from last_lines(request)
