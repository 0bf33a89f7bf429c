"""The course of docs/course.md, from its first command to its last."""

import re
import shlex
import subprocess
from pathlib import Path

from program import ekfsim

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "course.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
FAILS = "# ends with status 1"


def run(line):
    """Status and output of a line of a shell."""
    command = line.split("#")[0].strip()
    if command.startswith("ekfsim "):
        ended = ekfsim(*shlex.split(command)[1:], keys=b"nnepq")
        return ended.status, ended.out + ended.err
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def test_every_command_of_the_course_does_what_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told, lessons = "", 0
    for kind, block in BLOCKS:
        if kind != "sh":
            name = block.splitlines()[0].removeprefix("# ")
            Path(name).write_text(block, encoding="utf-8")
            continue
        for line in block.splitlines():
            if line.startswith("# > "):
                said = line.removeprefix("# > ")
                assert " ".join(said.split()) in " ".join(told.split()), line
                continue
            status, told = run(line)
            assert status == (1 if FAILS in line else 0), (line, told)
            lessons += 1
    assert lessons > 25


def test_the_course_names_pages_that_are_there():
    for page in re.findall(r"\]\((.*?)\)", PAGE):
        assert (DOCS / page).is_file()
