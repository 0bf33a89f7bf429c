"""The command line: each command an outline of what it does.

Heavy modules are imported where they are used.
"""

from typing import NoReturn

import click

from ekfsim.cli import comparing, driving, files, gallery, grading, process, runs, students, studies
from ekfsim.version import VERSION


def main() -> NoReturn:
    """The program `ekfsim`."""
    process.run(ekfsim)


@click.group(
    cls=process.Program,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(VERSION, message="%(prog)s %(version)s")
def ekfsim() -> None:
    """Simulate a robot that localizes itself with an extended Kalman filter,
    and read every calculation.

    COMMANDS is a commands file, or the name of one that comes along: try `ekfsim play tour` and
    press n.
    """


for command in (
    *(runs.play, driving.drive, runs.render, runs.plot, runs.run, runs.record),
    *(files.check, files.schema, files.list_packaged, files.show, files.new, files.figures),
    *(studies.study, studies.compare, gallery.gallery),
    *(comparing.diff, students.mutants, students.worksheet),
    *(grading.grade, grading.autograder),
):
    ekfsim.add_command(command)
