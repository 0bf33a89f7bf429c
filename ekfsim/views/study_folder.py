"""The folder of a study: two tables, three pictures, and all that is needed to repeat it."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from ekfsim.files.marked import scalar
from ekfsim.files.settings import Setting
from ekfsim.files.source import bytes_of
from ekfsim.files.writing import whole_folder
from ekfsim.study.plan import Plan, world_of
from ekfsim.study.results import Result
from ekfsim.study.tables import write_steps, write_summary
from ekfsim.version import VERSION
from ekfsim.views.study_pictures import draw_study

FILES = (
    *("summary.csv", "steps.csv", "study.yaml", "commands.yaml", "world.yaml"),
    *("nees.png", "coverage.png", "divergence.png"),
)


def write_study(plan: Plan, results: Sequence[Result], out: Path, force: bool) -> None:
    """Write the folder, whole or not at all."""
    with whole_folder(out, *FILES, force=force) as folder:
        with (folder / "summary.csv").open("w", newline="", encoding="utf-8") as file:
            write_summary(file, plan, results)
        with (folder / "steps.csv").open("w", newline="", encoding="utf-8") as file:
            write_steps(file, plan, results)
        draw_study(plan, results, folder)
        commands, world = plan.request.commands, world_of(plan.request)
        (folder / "commands.yaml").write_bytes(bytes_of(commands, str(commands)))
        (folder / "world.yaml").write_bytes(bytes_of(world, str(world)))
        (folder / "study.yaml").write_text("".join(f"{line}\n" for line in study_lines(plan)), encoding="utf-8")


def study_lines(plan: Plan) -> Iterator[str]:
    """A study file of this study; the commands and the world lie beside it as they were."""
    request = plan.request
    yield "# `ekfsim study study.yaml -o FOLDER` makes this study again."
    yield "study: commands.yaml"
    yield "world: world.yaml"
    yield f"runs: {request.runs}"
    yield f"seed: {plan.seed}"
    yield f"filters: [{', '.join(plan.filters)}]"
    if request.sweep:
        yield "sweep:"
        for values in request.sweep:
            yield f"  {values[0].key}: [{', '.join(map(written, values))}]"
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
    return "'" + one.value.replace("'", "''") + "'"
