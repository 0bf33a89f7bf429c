"""The commands for who grades: grade, autograder."""

import sys
from pathlib import Path

import click

from ekfsim.cli.program.kinds import Result, Source, Whole
from ekfsim.cli.program.options import FORCE
from ekfsim.cli.program.process import part_with, warn
from ekfsim.cli.program.progress import submissions_bar
from ekfsim.errors import RunError, UsageError
from ekfsim.printable import in_a_line


@click.command(short_help="Grade SUBMISSIONS by HOMEWORK.yaml, each in its own process.")
@click.argument("homework", metavar="HOMEWORK.yaml", type=Source())
@click.argument("submissions", metavar="SUBMISSION…", nargs=-1, required=True, type=Source())
@click.option("--out", "-o", type=Result(), required=True, help="A folder for the results.")
@click.option(
    "--format",
    "formats",
    metavar="NAME,…",
    default="csv,markdown",
    show_default=True,
    help="csv: grades.csv. markdown: a report each, and class.md. gradescope: results.json each. "
    "junit: junit.xml. Each report is written as JSON, too.",
)
@click.option(
    "--workers",
    type=Whole(1, 256),
    default=2,
    show_default=True,
    metavar="N",
    help="Submissions that are graded side by side.",
)
@click.option(
    "--through",
    metavar="COMMAND",
    default="",
    help="Begin students' code through a command, e.g. 'sudo -u nobody'; "
    "see docs/course/safety.md.",
)
@FORCE
def grade(
    homework: str, submissions: tuple[str, ...], out: Path, formats: str, workers: int,
    through: str, force: bool,
) -> None:  # fmt: skip
    """Grade SUBMISSIONS, files or folders, by what HOMEWORK.yaml asks for.

    What is graded is kept in OUT.partial until all is: the same command goes on with what is
    missing. With --force results are replaced; submissions that did not change keep their grade.
    """
    import shlex

    if sys.platform == "win32":
        raise UsageError("grade: students' code can be kept to no limits on Windows; use WSL")
    from ekfsim.files.homework import read_homework
    from ekfsim.files.results.writing import refuse_existing_folder
    from ekfsim.student.grading import grading, keeping
    from ekfsim.student.grading.formats.folder import FILES, formats_in, write_grades
    from ekfsim.student.grading.scores import checks_of
    from ekfsim.student.grading.sound import refuse_unsound
    from ekfsim.student.grading.submissions import odd
    from ekfsim.student.grading.submissions import submissions as handed_in
    from ekfsim.student.sandbox.kernel import lacking, landlock

    part_with()
    wanted, asked = formats_in(formats), read_homework(Path(homework))
    warn(asked.warnings)
    found = handed_in([Path(path) for path in submissions])
    warn(odd(found))
    refuse_existing_folder(out, *FILES, force=force)
    refuse_unsound(asked)
    lacks = () if through else lacking(landlock())
    if lacks:
        told = "; ".join(lacks)
        warn(
            [f"students' code is not kept from everything here: {told}; see docs/course/safety.md"]
        )
    work = grading.work_of(out)
    with keeping.kept_in(work, out, checks_of(asked.keys)) as kept:
        with submissions_bar(len(found), work) as done:
            grading.grade(asked, found, kept, workers, tuple(shlex.split(through)), done)
        of_all = write_grades(asked, found, kept.grade, out, wanted, force)
    keeping.remove(work)
    click.echo(in_a_line(f"{out}: {of_all.summed(asked.keys)}"))
    if of_all.unjudged:
        raise RunError(
            f"{of_all.unjudged} of {len(found)} submissions were not judged in all points; the "
            "reports say why, and the same command with --force tries those again"
        )


@click.command(short_help="Make the autograder.zip of Gradescope for HOMEWORK.yaml.")
@click.argument("homework", metavar="HOMEWORK.yaml", type=Source())
@click.option("--out", "-o", type=Result(), required=True, metavar="autograder.zip")
@FORCE
def autograder(homework: str, out: Path, force: bool) -> None:
    """Make the zip that Gradescope takes as an autograder: HOMEWORK.yaml with its scenes, this
    program, and the scripts that bring the Python it needs and grade a submission.
    """
    from ekfsim.files.homework import read_homework
    from ekfsim.student.grading.autograder.making import make
    from ekfsim.student.grading.sound import refuse_unsound

    asked = read_homework(Path(homework))
    warn(asked.warnings)
    refuse_unsound(asked)
    warn(make(asked, out, force))
    click.echo(in_a_line(f"{out}: upload it as the assignment's autograder"))
