"""Files that README, docs and docstrings of modules name are there."""

import ast
import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NAMED = re.compile(r"(?<![\w./-])(?:[\w.-]+/)*\w[\w-]*\.(?:py|md|cff)\b")
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
MODULES = [
    path for path in sorted((ROOT / "ekfsim").rglob("*.py")) if "_packaged" not in path.parts
]
FILES = [
    path.relative_to(ROOT).as_posix()
    for suffix in ("py", "md", "cff")
    for room in (".", "ekfsim", "tests", "docs", "benchmarks", "findings")
    for path in (ROOT / room).glob(f"*.{suffix}" if room == "." else f"**/*.{suffix}")
]
OTHERS = {
    "ekfsim/figures/writing.py": {"captions.md"},  # written by `ekfsim figures`
    "docs/reference/systems.md": {"captions.md"},
    # written by `ekfsim grade`, and by two students
    "docs/course/grading.md": {
        "class.md",
        *(f"handed-in/{name}/filter.py" for name in ("anna", "bob")),
    },
}
OTHERS["docs/course/course.md"] = {  # written by its commands, and by its reader
    *("half.py", "filled.py", "derivative.py", "class.md"),
    *("grades/class.md", "grades/report-ben.md"),
    *(f"sheets/{name}.md" for name in ("ada", "ben", "ada-beams")),
}
READERS = {"filter.py", "mine.py"}  # which a reader of the page writes


def text_of(path):
    text = path.read_text(encoding="utf-8")
    return text if path.suffix == ".md" else ast.get_docstring(ast.parse(text)) or ""


def there(name, beside):
    """Whether some file's path ends so, or leads there from the folder that names it."""
    near = os.path.normpath(beside / name)
    return os.path.exists(near) or any(f"/{file}".endswith(f"/{name}") for file in FILES)


@pytest.mark.parametrize("path", [*PAGES, *MODULES], ids=lambda path: str(path.relative_to(ROOT)))
def test_every_file_that_is_named_is_there(path):
    others = OTHERS.get(path.relative_to(ROOT).as_posix(), set())
    named = {name for name in NAMED.findall(text_of(path)) if not re.search("NAME|FILE", name)}
    assert {name for name in named - others - READERS if not there(name, path.parent)} == set()


@pytest.mark.parametrize(
    "path",
    [path for path in MODULES if path.name == "__init__.py"],
    ids=lambda path: path.parent.name,
)
def test_a_map_of_a_room_leaves_no_file_out(path):
    """A room whose docstring lists files of its own lists them all."""
    own = {other.name for other in path.parent.glob("*.py")} - {"__init__.py"}
    named = set(NAMED.findall(text_of(path)))
    assert len(named & own) < 2 or own <= named


def test_it_is_said_what_every_room_is_for():
    *_, block, _ = (
        (ROOT / "docs/reference/architecture.md").read_text(encoding="utf-8").split("```")
    )
    told = {place for line in block.splitlines() for place in line[:23].split()}
    assert {place for place in told if not (ROOT / place).exists()} == set()
    rooms = {f"ekfsim/{path.parent.name}/" for path in (ROOT / "ekfsim").glob("*/__init__.py")}
    assert rooms <= told


def test_no_two_files_of_tests_have_one_name():
    """They are collected together, and known by that alone."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(names) == sorted(set(names))
