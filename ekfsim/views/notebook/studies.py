"""The studies and comparisons of the command line, of a scene that a notebook holds."""

import csv
import io
import itertools
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ekfsim.errors import UsageError
from ekfsim.files.given.changes import OWN, scene_with, settings_of
from ekfsim.files.scenes.checking.filter_checks import refuse_unread
from ekfsim.files.scenes.load import load_scene
from ekfsim.files.scenes.load_study import FILTER, Request
from ekfsim.files.scenes.settings import Setting, distinct
from ekfsim.scene import Scene
from ekfsim.study.comparison import Comparison
from ekfsim.study.pairs import Pairs
from ekfsim.study.plan import Case, Plan
from ekfsim.study.recorded import Played, Recorded
from ekfsim.study.results import Result
from ekfsim.study.running.doing import total, unkept
from ekfsim.study.running.engines import Engine, pool, serial
from ekfsim.study.tables import write_summary
from ekfsim.twins import compiles
from ekfsim.views.notebook.cells import page, png
from ekfsim.views.notebook.table import framed
from ekfsim.views.study import compare_words, recorded_words, words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_RUNS, MOST_WORKERS = 10**9, 1024
Values = Mapping[str, object]
Named = str | Sequence[str] | None  # "ekf", "ekf,ukf" or ["ekf", "ukf"]


@dataclass(frozen=True, repr=False)
class Study:
    """What became of many runs: the words, the tables and the pictures of `ekfsim study`."""

    plan: Plan
    results: tuple[Result, ...]  # one for each cell and filter

    def __repr__(self) -> str:
        """The table and the verdicts."""
        return words.conclude(self.plan, self.results)

    def table(self) -> Any:
        """The columns of summary.csv, a row for each cell and filter: a DataFrame where pandas is
        installed.
        """
        file = io.StringIO()
        write_summary(file, self.plan, self.results)
        return _of_csv(file.getvalue())

    def figures(self) -> "dict[str, Figure]":
        """The three pictures: nees, coverage, divergence."""
        from ekfsim.views.study.pictures import PICTURES, picture

        return {
            name: picture(self.plan, self.results, title, quantities)
            for name, (title, quantities) in PICTURES.items()
        }

    def _repr_html_(self) -> str:
        return page(repr(self), [self._repr_png_()])

    def _repr_png_(self) -> bytes:
        from ekfsim.views.study.pictures import PICTURES, picture

        return png(picture(self.plan, self.results, *PICTURES["nees"]))


@dataclass(frozen=True, repr=False)
class LogStudy:
    """What became of one recorded run in each cell, by each filter."""

    plan: Recorded
    results: tuple[Played, ...]

    def __repr__(self) -> str:
        """The table, and what the innovations of each row show."""
        return recorded_words.conclude(self.plan, self.results)

    def table(self) -> Any:
        """The columns of summary.csv: a DataFrame where pandas is installed."""
        file = io.StringIO()
        recorded_words.write_summary(file, self.plan, self.results)
        return _of_csv(file.getvalue())

    def figure(self) -> "Figure":
        """NIS, and the error where the truth is known, over what was swept."""
        from ekfsim.views.study.recorded_folder import picture

        return picture(self.plan, self.results)

    def _repr_html_(self) -> str:
        return page(repr(self), [self._repr_png_()])

    def _repr_png_(self) -> bytes:
        return png(self.figure())


@dataclass(frozen=True, repr=False)
class Compared:
    """Two settings side by side on the same draws: what `ekfsim compare` says and draws."""

    comparison: Comparison
    found: Pairs

    def __repr__(self) -> str:
        """The table and a sentence for each measure."""
        return compare_words.conclude(self.comparison, self.found)

    def figure(self) -> "Figure":
        """Its picture."""
        from ekfsim.views.study.compare_picture import picture

        return picture(self.comparison, self.found)

    def _repr_html_(self) -> str:
        return page(repr(self), [png(self.figure())])

    def _repr_png_(self) -> bytes:
        return png(self.figure())


def study(
    scene: Scene | str | Path,
    runs: int = 10_000,
    sweep: Mapping[str, Iterable[object]] | None = None,
    filters: Named = None,
    seed: int | None = None,
    workers: int = 1,
    fast: bool = False,
) -> Study | LogStudy:
    """Run a scene many times: how often is it lost, and is the filter honest? The numbers are those
    of `ekfsim study`. A scene of a recorded log is one run: each cell is played once.

    sweep : values of a number, {"noise.rangeSigmaRatio": [0.01, 0.1]}; several keys make a grid;
    filters : that watch the same runs, "ekf,ukf" or a list; workers : processes; fast : by code
    that Numba compiles. Raises UsageError or InputError where what is asked is no sound scene.
    """
    scene, told = _asked(scene, True, seed=seed, filter=filters)
    grid = tuple(_values(key, values) for key, values in (sweep or {}).items())
    request = _request(scene, runs, fast, grid)
    if request.excess:
        raise UsageError("; ".join(request.excess))
    refuse_unread([one for values in grid for one in values], (scene.filter, *scene.beside))
    cases = []
    for values in itertools.product(*grid):
        cell, remarks = scene_with(scene, {one.key: one.value for one in values})
        told += remarks
        cases += [Case(values, one) for one in cell.alone()]
    _warn(told, 4)  # beneath the call of the package
    if scene.log is not None:
        recorded = Recorded(request, tuple(cases), ())
        return LogStudy(recorded, tuple(recorded.played()))
    plan = Plan(request, tuple(cases), ())
    return Study(plan, tuple(unkept(plan, _engine(workers), _unheard)))


def compare(
    scene: Scene | str | Path,
    a: Values | None = None,
    b: Values | None = None,
    runs: int = 10_000,
    filter: str | None = None,
    seed: int | None = None,
    workers: int = 1,
    fast: bool = False,
) -> Compared:
    """Put two settings of a scene side by side, each run under both on the same draws. The numbers
    are those of `ekfsim compare`.

    a, b : what either side sets, {"guard": "skip", "gate": 0.99}, its filter, too; nothing where
    left out. Raises UsageError or InputError where what is asked is no comparison.
    """
    example = "write e.g. a={'guard': 'off'}, b={'guard': 'skip', 'gate': 0.99}"
    for side in (a, b):
        if side is not None and not isinstance(side, Mapping):
            raise UsageError(f"compare: a and b are what either side sets of one scene; {example}")
    if not a and not b:
        raise UsageError(f"nothing is compared; {example}")
    scene, told = _asked(scene, seed=seed, filter=filter)
    if scene.beside:
        raise UsageError("compare: two filters are compared as a={'filter': …}, b={'filter': …}")
    request = _request(scene, runs, fast, ())
    plans = []
    for side in (a or {}, b or {}):
        for key in {"seed", "run"} & side.keys():
            raise UsageError(f"{key}: both sides have the same draws; give {key} to both")
        one, remarks = scene_with(scene, side)
        told += remarks
        own = tuple(settings_of({key: side[key] for key in side if key not in OWN}))
        plans.append(Plan(request.overruled(own, ()), (Case((), one),), ()))
    if _set(plans[0].cases[0].scene) == _set(plans[1].cases[0].scene):
        raise UsageError("compare: a and b are the same; let them differ")
    _warn(told, 3)
    comparison = Comparison(request, *plans)
    return Compared(comparison, total(comparison, comparison.tasks(), _engine(workers), _unheard))


def _asked(
    scene: Scene | str | Path, recorded: bool = False, **own: object
) -> tuple[Scene, list[str]]:
    """The scene that is meant, with its own seed and filters where they are given."""
    meant = scene if isinstance(scene, Scene) else load_scene(scene)
    if meant.log is not None and not recorded:
        name = meant.commands_source
        raise UsageError(f"{name}: a recording is one run only; sweep its settings with `study`")
    return scene_with(meant, {key: value for key, value in own.items() if value is not None})


def _request(scene: Scene, runs: int, fast: bool, grid: tuple[tuple[Setting, ...], ...]) -> Request:
    _whole("runs", runs, MOST_RUNS)
    if fast and not compiles():
        raise UsageError("fast needs Numba; install it with: pip install 'ekfsim[fast]'")
    settings = tuple(
        Setting(key, value, told)
        for told in scene.settings
        for key, _, value in [told.partition("=")]
    )
    name = scene.commands_source
    return Request(
        Path(name), None, runs, scene.seed, (scene.filter, *scene.beside), settings, grid,
        scene.reading, fast, name=name, commands_name=name, in_python=True,
    )  # fmt: skip


def _set(scene: Scene) -> tuple[object, ...]:
    """All that two sides of a comparison may differ in."""
    return scene.filter, scene.gate, scene.guard, scene.tuning, set(scene.settings)


def _values(key: str, values: Iterable[object]) -> tuple[Setting, ...]:
    """The settings of a swept key. Raises UsageError where there is none, or one stands twice."""
    if key in OWN:
        right = "name several by filters=" if key == FILTER else "give one by seed="
        raise UsageError(f"sweep: {key} is no number of a file; {right}")
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise UsageError(f"sweep: {key} needs a list of values; write e.g. {{{key!r}: [0.1, 0.2]}}")
    found = distinct(one for value in values for one in settings_of({key: value}))
    if not found:
        raise UsageError(f"sweep: {key} has no values; write e.g. {{{key!r}: [0.1, 0.2]}}")
    return found


def _engine(workers: int) -> Engine:
    _whole("workers", workers, MOST_WORKERS)
    return serial if workers == 1 else pool(workers)


def _whole(name: str, value: object, most: int) -> None:
    """Raises UsageError where it is no whole number, or not from 1 to the most."""
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= most:
        raise UsageError(f"{name}={value}: write a whole number from 1 to {most}")


def _warn(told: Iterable[str], level: int) -> None:
    for remark in dict.fromkeys(told):
        warnings.warn(remark, stacklevel=level)


def _unheard(task: object, made: object) -> None:
    """Nobody hears of single blocks."""


def _of_csv(text: str) -> Any:
    head, *rows = csv.reader(io.StringIO(text))
    columns = (list(map(_number, column)) for column in zip(*rows, strict=True))
    return framed(dict(zip(head, columns, strict=True)))


def _number(cell: str) -> object:
    for kind in (int, float):
        try:
            return kind(cell)
        except ValueError:
            continue
    return cell
