"""What scenes expose → CSV: a row for each scene and each known mistake."""

import csv
import math
from collections.abc import Mapping, Sequence
from typing import TextIO

from ekfsim.printable import cell
from ekfsim.scene import Scene
from ekfsim.student.exposing.exposed import Exposed
from ekfsim.student.exposing.statistics import seen
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.study.results import Result
from ekfsim.version import VERSION

FORMAT = 1  # grows when a column changes its meaning, or goes
SHOWN = ("commands", "seed", "run", "mistake", "can_be_made", "exposed")
FIRST = ("step", "at", "entry", "theirs", "right", "sigmas")
STATISTICS = ("runs", "above_50", "lost", "nis_mean", "statistics")
ORIGIN = ("told", "read", "ekfsim", "format")


def write_exposed(
    file: TextIO, scenes: Sequence[Scene], found: Sequence[Sequence[Exposed]],
    statistics: Mapping[Mistake, Result],
) -> None:  # fmt: skip
    """The first step at which each mistake shows in each scene; in SI units, angles in rad.

    statistics : of the one scene, where they were asked for
    """
    table = csv.writer(file, lineterminator="\n")
    table.writerow([*SHOWN, *FIRST, *(STATISTICS if statistics else ()), *ORIGIN])
    for scene, rows in zip(scenes, found, strict=True):
        for one in rows:
            judged = [_judged(statistics[one.mistake])] if statistics else []
            table.writerow(
                [
                    *(cell(scene.commands_source), scene.seed, scene.run, one.mistake.name),
                    *(int(one.possible), int(one.first is not None), *_first(one)),
                    *(number for numbers in judged for number in numbers),
                    *(one.mistake.told, one.mistake.read, VERSION, FORMAT),
                ]
            )


def _first(one: Exposed) -> tuple[object, ...]:
    if one.first is None:
        return ("",) * len(FIRST)
    most = one.first.most
    numbers = (repr(number) for number in (most.theirs, most.right, most.size))
    return one.first.asked.index, one.first.asked.step, most.entry, *numbers


def _judged(result: Result) -> tuple[object, ...]:
    nis = result.nis.value
    return (
        *(result.tally.runs, result.last.above_50.value, result.last.lost.value),
        *("" if math.isnan(nis) else nis, seen(result)),
    )
