"""Files to start from: every key with its unit and its default, and no mistake in them."""

from importlib.resources import files
from typing import Literal


def template(kind: Literal["world", "commands"]) -> str:
    """The text of a small file of a kind, explained in comments.

    >>> template("commands").splitlines()[-1].strip().startswith("- sense:")
    True
    """
    return files("ekfsim.files").joinpath("templates", f"{kind}.yaml").read_text(encoding="utf-8")
