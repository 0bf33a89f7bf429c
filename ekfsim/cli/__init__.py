"""The command line: each command an outline of what it does.

Heavy modules are imported where they are used.
"""

from collections.abc import MutableMapping
from typing import NoReturn, cast

import click

from ekfsim.cli.program import process
from ekfsim.late import Table
from ekfsim.version import VERSION

MODULES = {
    "runs.playing": ("play",),
    "runs.driving": ("drive",),
    "runs.drawing": ("render", "plot"),
    "runs.narrating": ("run",),
    "runs.recording": ("record",),
    "runs.explaining": ("why",),
    "studies.studies": ("study", "compare"),
    "studies.hunting": ("hunt",),
    "studies.tuning": ("tune",),
    "studies.gallery": ("gallery",),
    "files.files": ("check", "schema", "list_packaged", "show", "new", "figures"),
    "files.maps": ("world",),
    "students.comparing": ("diff",),
    "students.students": ("mutants", "worksheet"),
    "students.grading": ("grade", "autograder"),
}
PLACES = {
    name.removesuffix("_packaged"): f"ekfsim.cli.{module}:{name}"
    for module, names in MODULES.items()
    for name in names
}


def main() -> NoReturn:
    """The program `ekfsim`."""
    process.run(ekfsim)


@click.group(
    cls=process.Program,
    # click only reads it
    commands=cast("MutableMapping[str, click.Command]", Table[click.Command](PLACES)),
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(VERSION, message="%(prog)s %(version)s")
def ekfsim() -> None:
    """Simulate a robot that localizes itself with an extended Kalman filter,
    and read every calculation.

    COMMANDS is a commands file, or the name of one that comes along: try `ekfsim play tour` and
    press n.
    """
