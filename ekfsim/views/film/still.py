"""A single picture as a file: .png, .svg or .pdf, alike each time it is made."""

from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from ekfsim.errors import UsageError
from ekfsim.files.results.writing import refuse_existing, whole_file
from ekfsim.version import VERSION

KINDS = (".png", ".svg", ".pdf")


def refuse(target: Path, force: bool) -> None:
    """Raise UsageError where a file's name is not that of a single picture, or it may not be
    written.
    """
    if target.suffix.lower() not in KINDS:
        told = f"'{target.suffix}' is no" if target.suffix else "no ending tells the"
        raise UsageError(f"{target}: {told} kind of picture; name a .png, an .svg or a .pdf")
    refuse_existing(target, force)


def save(figure: Figure, target: Path, title: str, source: str, force: bool = False) -> None:
    """Write a figure whole or not at all; title and source go into its notes.

    Raises UsageError where the file is of another kind, or exists and `force` is False.
    """
    refuse(target, force)
    ending = target.suffix.lower().removeprefix(".")
    # svg draws names for its parts by lot, unless it is told what to begin with
    with whole_file(target, force) as path, rc_context({"svg.hashsalt": "ekfsim"}):
        figure.savefig(
            path, format=ending, dpi=figure.dpi, metadata=metadata(ending, title, source)
        )


def metadata(ending: str, title: str, source: str) -> dict[str, str | None]:
    """The notes in a picture's file, under the names that its format has;
    and no date, which would differ each time.
    """
    made_by = f"ekfsim {VERSION}"
    match ending:
        case "svg":
            return {"Title": title, "Description": source, "Creator": made_by, "Date": None}
        case "pdf":
            return {"Title": title, "Subject": source, "Creator": made_by, "CreationDate": None}
    return {"Title": title, "Description": source, "Software": made_by}
