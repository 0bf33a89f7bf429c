"""What a notebook shows of scenes, steps, views and summaries: words as they are printed, and the
picture of a frame.
"""

from collections.abc import Iterator
from functools import singledispatch

from ekfsim.diagnostics.summary import Summary
from ekfsim.localization import play
from ekfsim.provenance import provenance
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.notebook.cells import page, png
from ekfsim.views.picture.extent.scope import of as scope_of
from ekfsim.views.picture.frames import Frame
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import Judged, View
from ekfsim.views.why.answer import answer
from ekfsim.views.words.closing import conclude
from ekfsim.views.words.narrative.narrating import narrate
from ekfsim.why.records import Explanation

# the last one that was drawn, with its picture: a notebook asks for both, HTML and PNG
_last: tuple[object, bytes | None] = (None, None)


def html(one: object) -> str:
    """Words and picture."""
    drawn = picture(one)
    return page(words(one), [] if drawn is None else [drawn])


def picture(one: object) -> bytes | None:
    """The frame of a scene at its start, of a step as it ended, of a view; None where the scene is
    not known, and of what is no place.
    """
    global _last
    if _last[0] is not one and isinstance(one, Explanation):
        from ekfsim.views.why.picture import picture as picture_of  # seldom asked

        _last = one, png(picture_of(one))
    if _last[0] is not one:
        view, scene = _seen(one)
        drawn = None
        if view is not None and scene is not None:
            drawn = Frame(scene, scope_of(scene, [view.step])).png(view)
        _last = one, drawn
    return _last[1]


def _seen(one: object) -> tuple[View | None, Scene | None]:
    """The view that is drawn of it, and the scene that it is of."""
    if isinstance(one, Scene):
        return next(views(play(one))), one
    view = View(0, one, judged=Judged(one.nees)) if isinstance(one, Step) else one
    if not isinstance(view, View):
        return None, None
    scene = view.step.scene
    return view, scene if isinstance(scene, Scene) else None


@singledispatch
def words(one: object) -> str:
    """What is said of it."""
    return repr(one)


@words.register
def _(scene: Scene) -> str:
    told = {key: value for key, value in provenance(scene).items() if value is not None}
    lines = [f"{key:9} {value}" for key, value in told.items() if key != "ekfsim"]
    return "\n".join([*scene.description.strip().splitlines(), "", *lines]).strip()


@words.register
def _(view: View) -> str:
    scene = view.step.scene
    return narrate(view, scene) if isinstance(scene, Scene) else "\n".join(_numbers(view.step))


@words.register
def _(step: Step) -> str:
    scene = step.scene
    if not isinstance(scene, Scene) or step.posterior.mean.ndim > 1:
        return "\n".join(_numbers(step))
    told = [narrate(view, scene) for view in views([step])] if step.entry.index else []
    return "".join(told) or "\n".join(_numbers(step))


@words.register
def _(summary: Summary) -> str:
    return conclude(summary)


@words.register
def _(explanation: Explanation) -> str:
    return answer(explanation)


def _numbers(step: Step) -> Iterator[str]:
    """A step without its scene: the numbers that it holds."""
    yield repr(step)
    x, P = step.posterior
    if x.ndim == 1:
        yield f"state {', '.join(step.layout.names)}:"
        yield str(x)
        yield "covariance:"
        yield str(P)
    if step.correction is not None and x.ndim == 1:
        yield f"innovation {step.correction.innovation}, NIS {float(step.correction.nis):.6g}"
