"""The commands that make many runs: study, compare."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import engine_of
from ekfsim.cli.program.process import part_with, say, shown, warn, width
from ekfsim.cli.program.progress import blocks_bar, study_into
from ekfsim.cli.program.study_options import compare_options, study_options
from ekfsim.errors import RunError, UsageError

if TYPE_CHECKING:
    from ekfsim.files.scenes.load_study import Request


@click.command(short_help="Run COMMANDS many times: is the filter honest?")
@study_options
def study(
    out: Path | None,
    resume: bool,
    force: bool,
    workers: int,
    cluster: str | None,
    expect: bool,
    **asked: Any,
) -> None:
    """Run COMMANDS, or what a study file tells, many times:
    how often is it lost, and is the filter honest?
    """
    part_with()
    from ekfsim.files.scenes import load_study
    from ekfsim.files.scenes.checking.filter_checks import refuse_unread
    from ekfsim.study.expectation import promised, verified
    from ekfsim.study.plan import Plan, is_recorded
    from ekfsim.study.running.doing import unkept
    from ekfsim.study.running.engines import Paced
    from ekfsim.views.study.promises import broken, verify
    from ekfsim.views.study.words import conclude

    if out is None and resume:
        raise click.MissingParameter(param_hint="'--out' / '-o'", param_type="option")
    request = load_study.asked(**asked)
    if is_recorded(request):
        refuse_of_many(asked["runs"], workers, cluster, asked["fast"], resume, expect)
        return study_recorded(request, out, force)
    plan = Plan.of(request)
    refuse_unread(plan.settings, plan.filters)
    warn(plan.warnings)
    plan = promised(plan, asked["runs"]) if expect else plan
    engine = Paced(engine_of(workers, cluster))
    if out is None:
        with blocks_bar(plan.blocks * len(plan.cases)) as done:
            results = unkept(plan, engine, done)
    else:
        results = study_into(plan, engine, out, resume, force)
    if not expect:
        pace = engine.pace if plan.request.fast else 0.0
        click.echo(shown(conclude(plan, results, width(), pace)), nl=False)
        if out is None:
            say(
                "nothing of this is kept; -o FOLDER writes it with tables of every step, "
                "pictures, and what repeats it"
            )
        return
    found = verified(results[0])
    click.echo(shown(verify(plan, found)), nl=False)
    if told := broken(plan, found):
        raise RunError(told)


def refuse_of_many(
    runs: int | None, workers: int, cluster: str | None, fast: bool, resume: bool, expect: bool
) -> None:
    """Raises UsageError for an option that means something of many runs only."""
    given = {
        "--runs": runs is not None, "--workers": workers > 1, "--cluster": cluster is not None,
        "--fast": fast, "--resume": resume, "--expect": expect,
    }  # fmt: skip
    for option, is_given in given.items():
        if is_given:
            raise UsageError(f"{option}: a recording is one run, played once; leave this out")


def study_recorded(request: "Request", out: Path | None, force: bool) -> None:
    """Play each cell of a study of a recorded log, and say what came of it."""
    from ekfsim.files.scenes.checking.filter_checks import refuse_unread
    from ekfsim.study.recorded import Recorded
    from ekfsim.views.study.recorded_words import conclude

    plan = Recorded.of(request)
    refuse_unread(plan.settings, plan.filters)
    warn(plan.warnings)
    if out is not None:
        from ekfsim.views.picture.look import get_ready

        get_ready()
        from ekfsim.files.results.writing import refuse_existing_folder
        from ekfsim.views.study.recorded_folder import FILES, write_recorded

        refuse_existing_folder(out, *FILES, force=force)
    with blocks_bar(len(plan.cases), "cells") as done:
        found = plan.played(lambda: done(None, None))
    if out is not None:
        write_recorded(plan, found, out, force)
    click.echo(shown(conclude(plan, found, width())), nl=False)


@click.command(short_help="Put two settings side by side, on the same draws.")
@compare_options
def compare(
    a: str | None,
    b: str | None,
    out: Path | None,
    force: bool,
    workers: int,
    cluster: str | None,
    **asked: Any,
) -> None:
    """Put two settings of COMMANDS side by side, each run under both on the same draws."""
    part_with()
    from ekfsim.files.results.writing import refuse_existing_folder
    from ekfsim.files.scenes import load_study
    from ekfsim.study.comparison import Comparison, with_sides
    from ekfsim.study.running.doing import total
    from ekfsim.views.study.compare_words import conclude

    comparison = Comparison.of(with_sides(load_study.asked(**asked, sweeps=()), a, b))
    warn(comparison.warnings)
    if out is not None:
        from ekfsim.views.picture.look import get_ready

        get_ready()
        from ekfsim.views.study.compare_folder import FILES, write_comparison
        from ekfsim.views.study.folder import copies_in

        refuse_existing_folder(out, *FILES, *copies_in(out, comparison.filters), force=force)
    with blocks_bar(comparison.a.blocks) as done:
        found = total(comparison, comparison.tasks(), engine_of(workers, cluster), done)
    if out is not None:
        write_comparison(comparison, found, out, force)
    click.echo(shown(conclude(comparison, found, width())), nl=False)
