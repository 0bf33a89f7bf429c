"""The front of the gallery: one page with a picture and the figures of each scenario."""

from collections.abc import Sequence
from html import escape
from itertools import starmap

from ekfsim.version import VERSION
from ekfsim.views.gallery import cures
from ekfsim.views.gallery.exhibit import Exhibit, Wing
from ekfsim.views.page.document import filled, hashed, text_of
from ekfsim.views.study.shares import HEAD, MEANING

INDEX = "index.html"
CARD = """\
<article id="{name}">
<h3><a href="{name}.html">{name}</a></h3>
<p>{title}</p>
<a href="{name}.html"><img src="{name}.png" width="{width}" height="{height}" loading="lazy" \
alt="The last view of {name}: {judged}"></a>
<p class="verdict{warns}">{verdict}</p>
<table><caption>Of {runs} runs of seed {seed}</caption>
{rows}
</table>
{details}<p class="asked"><code>ekfsim play {name}</code></p>
</article>"""


def site(wings: Sequence[Wing]) -> str:
    """The page's text."""
    style = text_of("page.css") + text_of("gallery.css", "gallery")
    facts = {
        "policy": f"default-src 'none'; img-src 'self' data:; style-src '{hashed(style)}'; "
        "base-uri 'none'; form-action 'none'",
        "meaning": MEANING,
        "cures": cures.MEANING,
        "version": VERSION,
    }
    return filled(
        text_of("gallery.html", "gallery"),
        facts,
        {
            "style": style,
            "assumptions": "".join(
                f"<dt>{name}</dt><dd>{escape(cures.assumption(name))}</dd>" for name in cures.CURES
            ),
            "links": "\n".join(map(_links, wings)),
            "wings": "\n".join(map(_wing, wings)),
        },
    )


def _links(wing: Wing) -> str:
    """Where each scenario of a group hangs."""
    names = (f'<a href="#{name}">{name}</a>' for name in (each.name for each in wing.exhibits))
    return f"<dt>{escape(wing.title)}</dt><dd>{' '.join(names)}</dd>"


def _wing(wing: Wing) -> str:
    cards = "\n".join(map(_card, wing.exhibits))
    return (
        f'<section aria-labelledby="{wing.name}"><h2 id="{wing.name}">{escape(wing.title)}</h2>\n'
        f"{_cured(wing)}"
        f'<div class="cards">\n{cards}\n</div></section>'
    )


def _cured(wing: Wing) -> str:
    """The table of what becomes of a group's scenarios under each cure."""
    rows = [(shown.name, shown.cured) for shown in wing.exhibits if shown.cured is not None]
    if not rows:
        return ""
    head = "".join(f'<th scope="col"{_assumed(name)}>{escape(name)}</th>' for name in cures.HEAD)
    runs = cures.whose([found.runs for _, found in rows])
    caption = f"Lost under each filter, in % of {runs}: {cures.LEGEND}"
    body = "\n".join(starmap(_row, rows))
    return (
        f'<div class="wide"><table class="cures"><caption>{caption}</caption>\n'
        f"<thead><tr><td></td>{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>\n"
    )


def _assumed(name: str) -> str:
    """What a cure assumes, told where a mouse rests on its name."""
    return f' title="{escape(cures.assumption(name))}"' if name in cures.CURES else ""


def _row(name: str, found: cures.Cured) -> str:
    marks = [*(mark.name.lower() for mark in found.marks), "none", "none"]
    cells = "".join(
        f'<td class="{mark}">{escape(cell)}</td>'
        for mark, cell in zip(marks, found.cells, strict=True)
    )
    return f'<tr><th scope="row"><a href="#{name}">{name}</a></th>{cells}</tr>'


def _card(shown: Exhibit) -> str:
    rows = "\n".join(
        f'<tr><th scope="row">{escape(what)}</th><td>{escape(cell)}</td></tr>'
        for what, cell in zip(HEAD, shown.figures, strict=True)
    )
    details = (
        f"<details><summary>What to look at</summary><p>{escape(shown.told)}</p></details>\n"
        if shown.told
        else ""
    )
    width, height = shown.size
    return CARD.format(
        name=escape(shown.name), title=escape(shown.title), judged=escape(shown.judged),
        verdict=escape(f"The run shown: {shown.verdict}"), warns=" warns" if shown.warns else "",
        width=width, height=height, runs=shown.runs, seed=shown.seed, rows=rows, details=details,
    )  # fmt: skip
