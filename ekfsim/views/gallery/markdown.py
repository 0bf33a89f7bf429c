"""The gallery as one page of Markdown, for a repository."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from ekfsim.views.gallery.exhibit import Exhibit, Wing
from ekfsim.views.study.shares import HEAD, MEANING

INTRODUCTION = """\
# The gallery

Every scenario that comes along and needs no recorded log: the last view of its run, what that run \
comes to, and what many runs of it find. `ekfsim play NAME` steps through one, and `ekfsim gallery \
-o site` makes a web site of them all, with a page for each that plays in a browser. \
[scenarios](judging/scenarios.md) holds the failures against each other, and tells their cures.

{meaning}
"""


def markdown(wings: Sequence[Wing], pictures: Path) -> str:
    """The page's text. pictures : the folder that they lie in, as seen from the page"""
    return "\n".join(_paragraphs(wings, pictures))


def _paragraphs(wings: Sequence[Wing], pictures: Path) -> Iterator[str]:
    yield INTRODUCTION.format(meaning=MEANING)
    for wing in wings:
        names = (f"[{shown.name}](#{shown.name})" for shown in wing.exhibits)
        yield f"- {wing.title}: {', '.join(names)}"
    for wing in wings:
        yield f"\n## {wing.title[0].upper()}{wing.title[1:]}\n"
        yield "\n".join(section(shown, pictures) for shown in wing.exhibits)


def section(shown: Exhibit, pictures: Path) -> str:
    """What stands of one scenario."""
    head = " | ".join((f"{shown.runs} runs of seed {shown.seed}", *HEAD))
    cells = " | ".join(("", *shown.figures))
    return f"""\
### {shown.name}

![{shown.judged}]({(pictures / shown.name).as_posix()}.png)

**{shown.title}** {shown.told}

The run shown: {shown.verdict}.

| {head} |
|{"---|" * (1 + len(HEAD))}
| {cells} |
"""
