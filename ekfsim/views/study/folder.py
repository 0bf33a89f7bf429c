"""The folder of a study: two tables, three pictures, why its worst run was lost, and all that is
needed to repeat it.
"""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from ekfsim.commands import expanded_length
from ekfsim.files.results.writing import whole_folder
from ekfsim.files.scenes.load_study import Request
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.source import bytes_of
from ekfsim.files.yaml.marked import scalar
from ekfsim.filters import FILTERS
from ekfsim.study.code import Copies
from ekfsim.study.plan import Plan, as_option, way_of, world_of
from ekfsim.study.results import Result
from ekfsim.study.tables import write_steps, write_summary
from ekfsim.version import VERSION
from ekfsim.views.study.pictures import draw_study
from ekfsim.views.study.words import explained
from ekfsim.views.why.asked import is_quick

REPEATING = ("study.yaml", "compare.yaml")
REASON = "why.txt"  # only where runs are lost
LONGEST = 500  # commands of a run that is played again some hundred times
FILES = (
    *("summary.csv", "steps.csv", "study.yaml", "commands.yaml", "world.yaml"),
    *("nees.png", "coverage.png", "divergence.png", REASON),
)


def write_study(plan: Plan, results: Sequence[Result], out: Path, force: bool) -> None:
    """Write the folder, whole or not at all."""
    copies = Copies.of(plan.filters)
    with whole_folder(out, *FILES, *copies_in(out, plan.filters), force=force) as folder:
        with (folder / "summary.csv").open("w", newline="", encoding="utf-8") as file:
            write_summary(file, plan, results)
        with (folder / "steps.csv").open("w", newline="", encoding="utf-8") as file:
            write_steps(file, plan, results)
        draw_study(plan, results, folder)
        if reason := reason_of(results):
            (folder / REASON).write_text(reason, encoding="utf-8")
        lines = study_lines(plan, copies.names)
        write_to_repeat(plan.request, folder / "study.yaml", lines, copies.files)


def reason_of(results: Sequence[Result]) -> str:
    """Why the worst run of all rows was lost; nothing where no more are lost than chance does, and
    where playing it again takes long.
    """
    lost = [one for one in results if explained(one)]
    if not lost:
        return ""
    worst = max(lost, key=lambda one: (one.tally.worst.impossible, one.tally.worst.nees))
    scene = replace(worst.case.scene, run=worst.tally.worst.run, beside=())
    if expanded_length(scene.commands) > LONGEST or not is_quick(scene):
        return ""
    from ekfsim.views.why.answer import answer
    from ekfsim.why import explain  # only here, and seldom

    values = "".join(f"{one}\n" for one in worst.case.values)
    return values + answer(explain(scene))


def copies_in(out: Path, filters: Iterable[str]) -> Iterator[str]:
    """The code of filters that may be replaced in a folder: what a study or a comparison copied
    there, beside the file that repeats it.
    """
    if any(os.path.exists(out / name) for name in REPEATING):
        yield from Copies.of(filters).files


def write_to_repeat(
    request: Request, file: Path, lines: Iterable[str], code: Mapping[str, bytes]
) -> None:
    """Write a study file, and beside it the commands, the world and the code of filters as they
    were.
    """
    world = world_of(request)
    file.with_name("commands.yaml").write_bytes(bytes_of(request.commands, str(request.commands)))
    file.with_name("world.yaml").write_bytes(bytes_of(world, str(world)))
    for name, contents in code.items():
        copy = file.parent / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(contents)
    file.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")


def study_lines(plan: Plan, names: Mapping[str, str]) -> Iterator[str]:
    """A study file of this study; `names` is how it names its filters."""
    request = plan.request
    plain = as_option(way_of(request))
    yield f"# `ekfsim study study.yaml -o FOLDER{plain}` makes this study again."
    yield from first_lines(request, plan.seed)
    yield f"filters: [{', '.join(in_yaml(names[filter]) for filter in plan.filters)}]"
    if request.sweep:
        yield "sweep:"
        for values in request.sweep:
            yield f"  {values[0].key}: [{', '.join(map(written, values))}]"
    yield from last_lines(request)


def first_lines(request: Request, seed: int) -> Iterator[str]:
    """Which runs of what."""
    yield "study: commands.yaml"
    yield "world: world.yaml"
    yield f"runs: {request.runs}"
    yield f"seed: {seed}"


def last_lines(request: Request) -> Iterator[str]:
    """What is set for all cells or for both sides, and how it is calculated."""
    if request.settings:
        yield "set:"
        yield from (f"  {one.key}: {written(one)}" for one in request.settings)
    yield f"reading: {request.reading}"
    if request.fast:
        yield "fast: true"
    yield f"ekfsim: '{VERSION}'"


def written(one: Setting) -> str:
    """A value as YAML: numbers as they were written, words in quotes."""
    if isinstance(scalar(one.value), int | float):
        return one.value
    return in_quotes(one.value)


def in_yaml(filter: str) -> str:
    """How a file names a filter."""
    return filter if filter in FILTERS else in_quotes(filter)


def in_quotes(text: str) -> str:
    """A text that YAML takes for nothing else."""
    return "'" + text.replace("'", "''") + "'"
