"""The picture of one step in a file."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.results.writing import whole_file
from ekfsim.provenance import metadata, told_in_a_line
from ekfsim.scene import Scene
from ekfsim.views.curves.series import Series
from ekfsim.views.curves.strip import framed
from ekfsim.views.film import still
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.frames import Picture
from ekfsim.views.picture.look import SCREEN, STANDARD, Look, Paper
from ekfsim.views.playback.view import View


def render(
    view: View,
    scene: Scene,
    scope: Scope,
    target: Path,
    *,
    look: Look = STANDARD,
    paper: Paper = SCREEN,
    strip: Sequence[Series] = (),
    force: bool = False,
) -> None:
    """Draw a view into a .png, the same as in a folder of all, or into an .svg or a .pdf, which
    need no font where they are shown. With a strip of the curves of each filter
    beneath it, where they are given, in a .png alone.

    Raises UsageError where the file is of another kind, or exists and `force` is False.
    """
    still.refuse(target, force)
    if target.suffix.lower() == ".png":
        picture = framed(scene, scope, look, paper, strip).png(
            view, {**metadata(scene), "View": str(view.number)}
        )
        with whole_file(target, force) as path:
            path.write_bytes(picture)
        return
    if strip:
        raise UsageError(f"{target}: --strip is made of pixels; name a .png, or see `ekfsim plot`")
    drawn = Picture.on(paper, scene, scope, look)
    drawn.show(view)
    still.save(drawn.figure, target, drawn.title.get_text(), told_in_a_line(scene), force)


def find(views: Iterable[View], step: int, beam: bool) -> View:
    """The view that shows a step as it ended, or the beam of its reading. Where a view gathers
    many steps it is the one that has this step among them.

    Raises UsageError where there is none.
    """
    view = None
    for view in views:
        index = view.step.entry.index
        if index >= step and view.beam == beam:
            break
        if index >= step and beam:
            raise UsageError(f"--step {step}b: step {step} is no reading; leave out the b")
    else:
        last = 0 if view is None else view.step.entry.index
        raise UsageError(f"--step {step}: the last step is {last}")
    if beam and view.step.entry.index > step:
        raise UsageError(f"--step {step}b: step {step} is no reading; leave out the b")
    return view
