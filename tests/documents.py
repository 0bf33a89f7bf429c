"""The texts of the five documents, where they are at hand."""

from pathlib import Path

import pytest

DOCUMENTS = Path(__file__).resolve().parents[1] / ".." / "shared" / "documents"


def as_written(number):
    """A document's text, every run of white space one blank. Skips the test where the text is not
    there."""
    found = sorted(DOCUMENTS.glob(f"{number}_*.txt"))
    if not found:
        pytest.skip("the documents are not at hand")
    return " ".join(found[0].read_text(encoding="utf-8").split())


def equation(number, tag):
    """What stands between the dollar signs of one equation, without blanks."""
    before, found, _ = as_written(number).partition(rf"\quad ({tag})$$")
    assert found, f"document {number} has no equation {tag}"
    return before.rpartition("$$")[2].replace(" ", "")
