"""What goes into autograder.zip: the same homework makes the same bytes."""

import json
import os
import re
import tempfile
import tomllib
import zipfile
from collections.abc import Iterator, Mapping
from importlib import metadata, resources
from pathlib import Path, PurePosixPath

from ekfsim.errors import EkfsimError, UsageError
from ekfsim.files.homework import Homework, read_homework
from ekfsim.files.packaged import PACKAGE, folder
from ekfsim.files.results.writing import told, whole_file
from ekfsim.student.grading.formats.gradescope import nothing_yet
from ekfsim.student.grading.scores import checks_of
from ekfsim.student.sandbox.limits import patience
from ekfsim.version import VERSION

PYTHON = "3.12"
SCRIPTS = ("setup.sh", "run_autograder")
EPOCH = (1980, 1, 1, 0, 0, 0)  # the first instant that a zip knows
EXECUTABLE, PLAIN = 0o100755, 0o100644
BEGUN = (
    "The grader began and did not end: it was stopped, or took longer than the platform allows. "
    "Nothing was judged; ask your instructor."
)
FAILED = "The grader itself failed. Nothing was judged, by no fault of yours; ask your instructor."
SPARE = 60  # s, to begin and to write
MOST_SECONDS = 2400  # that Gradescope gives at most
MOST_MEMORY = 512  # MiB of a student's process, beside which the grader fits into 768 MB
USUAL_SECONDS = 600  # that it gives where nobody asks for more


def make(homework: Homework, out: Path, force: bool) -> list[str]:
    """Write the zip; what is to be said of it.

    Raises UsageError where the homework could not be found in it.
    """
    files = dict(_files(homework))
    with whole_file(out, force) as beside, told(out), zipfile.ZipFile(beside, "w") as made:
        for name in sorted(files):
            mode = EXECUTABLE if name in SCRIPTS else PLAIN
            one = zipfile.ZipInfo(name, EPOCH)
            one.external_attr, one.compress_type = mode << 16, zipfile.ZIP_DEFLATED
            made.writestr(one, files[name])
    return list(_remarks(homework))


def longest(homework: Homework) -> int:
    """Seconds that the grading of a submission may take, if its code sleeps in each test."""
    return round(len(checks_of(homework.keys)) * patience(homework.keys.limits.seconds)) + SPARE


def _remarks(homework: Homework) -> Iterator[str]:
    seconds = longest(homework)
    if seconds > USUAL_SECONDS:
        yield (
            f"a submission whose code sleeps in each test takes {seconds} s; Gradescope stops "
            f"after {USUAL_SECONDS} s unless its settings say more (at most {MOST_SECONDS}): lower "
            "limits.seconds, or raise it there"
        )

    if homework.keys.limits.memory > MOST_MEMORY:
        yield (
            f"limits.memory is {homework.keys.limits.memory} MiB; Gradescope's usual container has "
            f"768 MB: where a student's code takes all of it, the grader may be killed; "
            f"{MOST_MEMORY} fits"
        )


def _files(homework: Homework) -> Iterator[tuple[str, bytes]]:
    copies = _copies(homework)
    own = copies[homework.path]
    _refuse_what_is_not_found(homework, copies)
    for path, name in copies.items():
        yield str(name), path.read_bytes()
    yield from _program()
    yield "requirements.txt", "".join(f"{one}\n" for one in requirements()).encode()
    texts = {
        "VERSION": VERSION, "PYTHON": PYTHON, "HOMEWORK": str(own),
        "SECONDS": str(min(longest(homework) + SPARE, MOST_SECONDS - SPARE)),
        "BEGUN": _json(BEGUN), "FAILED": _json(FAILED),
    }  # fmt: skip
    for script in SCRIPTS:
        text = resources.files(__package__ or "").joinpath(f"{script}.txt").read_text("utf-8")
        yield script, re.sub("@([A-Z]+)@", lambda found: texts[found[1]], text).encode()


def _json(why: str) -> str:
    return json.dumps(nothing_yet(why), indent=1, allow_nan=False)


def _copies(homework: Homework) -> dict[Path, PurePosixPath]:
    """Where the files of a homework lie in the zip, each to the other as they lie here. What comes
    along with the program is not copied.
    """
    ours = {folder("commands").resolve(), folder("worlds").resolve()}
    own = [path for path in homework.files if Path(os.path.realpath(path)).parent not in ours]
    places = [Path(os.path.abspath(path)) for path in own]
    above = Path(os.path.commonpath([place.parent for place in places]))
    return {
        path: PurePosixPath("homework", *place.relative_to(above).parts)
        for path, place in zip(own, places, strict=True)
    }


def _refuse_what_is_not_found(homework: Homework, copies: Mapping[Path, PurePosixPath]) -> None:
    """Raise UsageError where the copies name files that they do not bring along."""
    with tempfile.TemporaryDirectory() as there:
        for path, name in copies.items():
            place = Path(there, name)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(path.read_bytes())
        try:
            found = read_homework(Path(there, copies[homework.path]))
        except EkfsimError as error:
            told = str(error).partition("\n")[0].replace(f"{there}{os.sep}", "")
            raise UsageError(f"{homework.path}: cannot be copied: {told}") from None
    ours = set(map(Path, homework.files)) - set(copies)
    for path in found.files:
        if not path.is_relative_to(there) and path not in ours:
            raise UsageError(f"{path}: is named by its absolute path; name it relative to its file")


def _program() -> Iterator[tuple[str, bytes]]:
    """The program as it stands, with the worlds and commands that come along."""
    for path in sorted(PACKAGE.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts and "_packaged" not in path.parts:
            yield f"program/ekfsim/{path.relative_to(PACKAGE).as_posix()}", path.read_bytes()
    for path in (*folder("worlds").glob("*.yaml"), *folder("commands").rglob("*")):
        if path.is_file():
            inner = path.relative_to(path.parents[0 if path.parent.name != "pictures" else 1])
            kind = "worlds" if path.is_relative_to(folder("worlds")) else "commands"
            yield f"program/ekfsim/_packaged/{kind}/{inner.as_posix()}", path.read_bytes()


def requirements() -> list[str]:
    """What this program needs, each in the version that it is graded with here."""
    try:
        needed = metadata.requires("ekfsim") or []
    except metadata.PackageNotFoundError:  # a checkout
        project = PACKAGE.parent / "pyproject.toml"
        needed = tomllib.loads(project.read_text(encoding="utf-8"))["project"]["dependencies"]
    names = [re.split(r"[^\w.-]", one)[0] for one in needed if "extra ==" not in one]
    return [f"{name}=={metadata.version(name)}" for name in names]
