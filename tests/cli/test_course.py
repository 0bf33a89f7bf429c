"""The course of docs/course/course.md, from its first command to its last."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from program import ekfsim

PAGE = (Path(__file__).parents[2] / "docs/course/course.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FAILS = "# ends with status 1"
MATHEMATICS = {"0.954", "86.5"}  # a probability in a formula; per cent within 2σ in the plane
CHEAPER = {"grade": ["--workers", "1"]}  # and the same grades


def run(line: str) -> tuple[int, str]:
    """Status and output of a line of a shell."""
    command, _, file = line.split("#")[0].strip().partition(" > ")
    if command.startswith("ekfsim "):
        _, what, *args = shlex.split(command)
        ended = ekfsim(what, *args, *CHEAPER.get(what, []), keys=b"nnepq")
        if file:
            Path(file).write_text(ended.out, encoding="utf-8")
        return ended.status, ended.out + ended.err
    words = [{"python": sys.executable}.get(word, word) for word in shlex.split(command)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="students' code is graded on a POSIX system")
def test_every_command_of_the_course_does_what_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told, all_told, commands = "", "", 0
    for kind, block in BLOCK.findall(PAGE):
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
            all_told += told
            commands += 1
    assert commands > 50
    figures = set(re.findall(r"\d+\.\d+", BLOCK.sub("", PAGE)))
    assert figures - MATHEMATICS <= set(re.findall(r"\d+\.\d+", all_told))
