"""docs/course/grading.md: its commands do what the page says of them."""

import csv
import re
import shlex
import sys
from pathlib import Path

import pytest
from program import ekfsim

PAGE = Path(__file__).parents[2] / "docs/course/grading.md"


@pytest.mark.skipif(sys.platform == "win32", reason="students' code needs a POSIX")
def test_every_command_of_the_page_is_done(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = PAGE.read_text(encoding="utf-8")
    (block,) = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    commands = [shlex.split(line, comments=True) for line in block.splitlines()]
    assert len(commands) == 7
    for program, *args in commands:
        assert program == "ekfsim"
        told = ekfsim(*args)
        assert told.status == 0, (args, told.err)
    named = re.findall(r"^\| `([\w.-]+)` \|", text, re.MULTILINE)
    files = {name for name in named if "." in name}
    students = {name.replace("NAME", student) for name in files for student in ("anna", "bob")}
    assert {path.name for path in Path("grades").iterdir()} == students
    with open("grades/grades.csv", encoding="utf-8", newline="") as file:
        points = {row["submission"]: row["points"] for row in csv.DictReader(file)}
    assert points == {"anna": "80", "bob": "0"}  # all but the inputs that she did not hand in
