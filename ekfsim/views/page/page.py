"""One self-contained page that plays a run: a step is one press of n."""

import json
from collections.abc import Iterable, Sequence
from contextlib import redirect_stderr
from dataclasses import dataclass
from html import escape
from io import StringIO
from typing import Any, Self

from ekfsim.commands import expanded_length
from ekfsim.printable import in_a_line, shown
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.page.document import filled, hashed, text_of
from ekfsim.views.page.holding import Holding
from ekfsim.views.page.scenery import framed, inks, origin_of, scenery
from ekfsim.views.page.told import Teller, ways
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.look import STANDARD, Look
from ekfsim.views.playback.kept import kept
from ekfsim.views.playback.playback import Tally, together
from ekfsim.views.playback.view import View

# in this order
SCRIPTS = (
    "shapes.js",
    "picture.js",
    "matrices.js",
    "strips.js",
    "legend.js",
    "page.js",
)
INERT = str.maketrans(  # what could end the script, or a line of it
    {sign: f"\\u{ord(sign):04x}" for sign in "<>&\u2028\u2029"}
)


@dataclass(frozen=True)
class Page:
    """A page, and how much of its run it holds."""

    text: str
    views: int
    held: int

    @classmethod
    def of(
        cls,
        scene: Scene,
        runs: Sequence[Iterable[Step]],
        look: Look = STANDARD,
        every: int = 1,
        reason: str = "",
    ) -> Self:
        """Of a run that one filter watches, or several.

        runs : the steps of each filter, the scene's own first; each is read twice
        every : of how many views one is held, at least; of a long drive it is of more
        reason : why the run was lost, as it is told; empty where that was not asked
        """
        tally, (first, *others) = Tally(), runs
        with redirect_stderr(StringIO()):  # what a filter prints it prints again
            steps = kept(first, [tally.write])
            scope = scopes.of_all(scene, (steps, *others), look.probability)
        origin, holding = origin_of(scope.whole), Holding(tally.views, every)
        teller = Teller(scene, look, origin, scope.whole.size, expanded_length(scene.commands))
        views: list[str] = []
        last: View | None = None
        limits: list[list[Any]] = []  # of the map, each with the view from which on they hold
        for view in holding.choose(together(first, others, (scene.filter, *scene.beside))):
            if (seen := framed(scope.at(view), origin)) != (limits and limits[-1][1:]):
                limits.append([len(views), *seen])
            views.append(inert(teller.tell(view)))
            last = view
        assert last is not None
        fixed = scenery(scene, look, origin) | {
            "limits": limits,
            "ways": ways(last, origin),
            "last": last.step.entry.index,
            "lines": teller.lines.texts,
        }
        lesson = f'{inert(fixed)[:-1]},"views":[\n' + ",\n".join(views) + "\n]}"
        thinned = left_out(tally.views, len(views))
        return cls(_filled(scene, lesson, thinned, reason), tally.views, len(views))

    @property
    def left_out(self) -> str:
        """What is left out, in a sentence; empty where nothing is."""
        return left_out(self.views, self.held)


def page(scene: Scene, runs: Sequence[Iterable[Step]], look: Look = STANDARD) -> str:
    """The page's text. runs : the steps of each filter, as lists say"""
    return Page.of(scene, runs, look).text


def left_out(views: int, held: int) -> str:
    """That a page does not hold all of the run's views; empty where it does.

    >>> left_out(1424, 801)
    "801 of the run's 1424 views are held: at even distances, and wherever something happens"
    >>> left_out(46, 46)
    ''
    """
    if held == views:
        return ""
    where = "at even distances, and wherever something happens"
    return f"{held} of the run's {views} views are held: {where}"


def inert(value: Any) -> str:
    r"""JSON that no text in it can end or break.

    >>> print(inert("</script><!-- & \u2028"))
    "\u003c/script\u003e\u003c!-- \u0026 \u2028"
    """
    told = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return told.translate(INERT)


def _filled(scene: Scene, lesson: str, thinned: str, reason: str) -> str:
    """The page's text with everything in its place."""
    style = inks() + text_of("page.css")
    script = "(() => {\n" + "".join(map(_script, SCRIPTS)) + "})();\n"
    heading, *rest = shown(scene.description.strip() or scene.world.name).splitlines()
    facts = {
        "policy": f"default-src 'none'; img-src data:; style-src '{hashed(style)}'; "
        f"script-src '{hashed(script)}'; base-uri 'none'; form-action 'none'",
        "title": in_a_line(heading),
        "rest": " ".join(line.strip() for line in rest),
        "thinned": thinned,
        "source": in_a_line(told_in_a_line(scene)),
    }
    markup = {"style": style, "script": script, "lesson": lesson, "why": panel(reason)}
    return filled(text_of("page.html"), facts, markup)


def panel(reason: str) -> str:
    """The panel that tells why the run ended as it did; none where that was not asked.

    >>> print(panel("a < b"), end="")
    <details id="why"><summary>Why, and what cures it</summary><pre>a &lt; b</pre></details>
    """
    if not reason:
        return ""
    summary = "<summary>Why, and what cures it</summary>"
    return f'<details id="why">{summary}<pre>{escape(reason.rstrip())}</pre></details>\n'


def _script(name: str) -> str:
    """A script without what its lines are set in by: a page is to be small enough to be mailed."""
    return "".join(line.lstrip() for line in text_of(name).splitlines(keepends=True))
