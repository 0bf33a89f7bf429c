"""The folder of a study of a log: its table, its picture, and what repeats it."""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ekfsim.files.results.writing import whole_folder
from ekfsim.files.yaml.marked import scalar
from ekfsim.study.recorded import Played, Recorded
from ekfsim.version import VERSION
from ekfsim.views.study.folder import in_quotes, in_yaml, last_lines, written
from ekfsim.views.study.recorded_words import nis, write_summary
from ekfsim.views.study.sheet import GREY, save, sheet

FILES = ("summary.csv", "log.png", "study.yaml")


def write_recorded(plan: Recorded, found: Sequence[Played], out: Path, force: bool) -> None:
    """Write the folder, whole or not at all."""
    with whole_folder(out, *FILES, force=force) as folder:
        with (folder / "summary.csv").open("w", newline="", encoding="utf-8") as file:
            write_summary(file, plan, found)
        save(picture(plan, found), folder / "log.png", told(plan))
        text = "".join(f"{line}\n" for line in study_lines(plan))
        (folder / "study.yaml").write_text(text, encoding="utf-8")


def study_lines(plan: Recorded) -> Iterator[str]:
    """A study file of this study. It names commands, world and log where they lie."""
    request = plan.request
    yield "# `ekfsim study study.yaml -o FOLDER` makes this study again."
    yield f"study: {in_quotes(os.path.abspath(request.commands))}"
    if request.world is not None:
        yield f"world: {in_quotes(os.path.abspath(request.world))}"
    if request.log is not None:
        yield f"log: {in_quotes(os.path.abspath(request.log))}"
    yield f"filters: [{', '.join(in_yaml(filter) for filter in plan.filters)}]"
    if request.sweep:
        yield "sweep:"
        for values in request.sweep:
            yield f"  {values[0].key}: [{', '.join(map(written, values))}]"
    yield from last_lines(request)


def told(plan: Recorded) -> str:
    """What made the picture, in a line."""
    scene = plan.cases[0].scene
    facts = [f"ekfsim {VERSION}", f"commands {scene.commands_source}", f"log {scene.log_source}"]
    return ", ".join([*facts, *(f"set {one}" for one in plan.request.settings)])


def picture(plan: Recorded, found: Sequence[Played]) -> Figure:
    """NIS per number read with its band, and the error where the truth is known, over the values of
    the first key; a line for each filter and each cell of the other keys.
    """
    known = any(one.summary.position.rmse is not None for one in found)
    figure = sheet(8.0, 4.2 if known else 3.2, "One recorded run, filtered anew", told(plan))
    rows = figure.subplots(1 + known, 1, sharex=True, squeeze=False)[:, 0]
    words = list(dict.fromkeys(one.case.values[0].value for one in found if one.case.values))
    numbers = [scalar(word) for word in words]
    numeric = len(words) > 1 and all(isinstance(n, int | float) for n in numbers)
    lines = dict[str, list[Played]]()
    for one in found:
        name = ", ".join([*map(str, one.case.values[1:]), one.case.filter])
        lines.setdefault(name, []).append(one)
    for name, cells in lines.items():
        x = [float(scalar(c.case.values[0].value)) if numeric else float(i)  # type: ignore[arg-type]
             for i, c in enumerate(cells)]  # fmt: skip
        measured = np.array([[np.nan if v is None else v for v in nis(one)] for one in cells])
        rows[0].plot(x, measured[:, 0], "o-", ms=4, label=name)
        rows[0].fill_between(x, measured[:, 1], measured[:, 2], color=GREY, alpha=0.15, lw=0)
        if known:
            rmse = [one.summary.position.rmse for one in cells]
            rows[1].plot(x, [np.nan if e is None else e for e in rmse], "o-", ms=4, label=name)
    rows[0].set(ylabel="NIS per number read", yscale="log")
    rows[0].axhline(1.0, color=GREY, lw=0.9)
    if known:
        rows[1].set_ylabel("position RMSE (m)")
    _along(rows[-1], plan, words, numeric, [float(n) for n in numbers] if numeric else [])  # type: ignore[arg-type]
    rows[0].legend(fontsize=8, frameon=False)
    return figure


def _along(
    axes: Axes, plan: Recorded, words: Sequence[str], numeric: bool, numbers: Sequence[float]
) -> None:
    """The axis of what was swept."""
    axes.set_xlabel(plan.keys[0] if plan.keys else "")
    if numeric and min(numbers) > 0 and max(numbers) / min(numbers) > 20:
        axes.set_xscale("log")
    elif not numeric:
        axes.set_xticks(range(len(words)), words)
