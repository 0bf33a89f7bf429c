"""The gallery as one page of Markdown, for a repository."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from ekfsim.views.gallery import cures
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
CURES = """\
Under the head of each group a table holds the cures side by side. {meaning} \
[Cures](judging/cures.md) tells which one to take.

{assumptions}
"""


def markdown(wings: Sequence[Wing], pictures: Path) -> str:
    """The page's text. pictures : the folder that they lie in, as seen from the page"""
    return "\n".join(_paragraphs(wings, pictures))


def _paragraphs(wings: Sequence[Wing], pictures: Path) -> Iterator[str]:
    yield INTRODUCTION.format(meaning=MEANING)
    if any(shown.cured for wing in wings for shown in wing.exhibits):
        told = (f"- `{name}`: {cures.assumption(name)}" for name in cures.CURES)
        yield CURES.format(meaning=cures.MEANING, assumptions="\n".join(told))
    for wing in wings:
        names = (f"[{shown.name}](#{shown.name})" for shown in wing.exhibits)
        yield f"- {wing.title}: {', '.join(names)}"
    for wing in wings:
        yield f"\n## {wing.title[0].upper()}{wing.title[1:]}\n"
        yield from _cured(wing)
        yield "\n".join(section(shown, pictures) for shown in wing.exhibits)


def _cured(wing: Wing) -> Iterator[str]:
    """The table of what becomes of a group's scenarios under each cure."""
    rows = [(shown.name, shown.cured) for shown in wing.exhibits if shown.cured is not None]
    if not rows:
        return
    yield f"| {cures.whose([found.runs for _, found in rows])} | {' | '.join(cures.HEAD)} |"
    yield f"|---|{'--:|' * len(cures.HEAD)}"
    yield from (row(name, found) for name, found in rows)
    yield ""


def row(name: str, found: cures.Cured) -> str:
    """What becomes of one scenario under each cure."""
    return f"| [{name}](#{name}) | {' | '.join(found.cells)} |"


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
