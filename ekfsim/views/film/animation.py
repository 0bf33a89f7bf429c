"""A run as pictures: PNG files in a folder, named by their steps, a GIF or an MP4.
Memory does not grow with their number.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from ekfsim.commands import expanded_length
from ekfsim.errors import UsageError
from ekfsim.files.looking import is_folder
from ekfsim.files.results.writing import refuse_existing, told, whole_file, whole_folder
from ekfsim.provenance import metadata, told_in_a_line
from ekfsim.scene import Scene
from ekfsim.views.curves.series import Series
from ekfsim.views.curves.strip import Stripped, framed
from ekfsim.views.film import gif, still, video
from ekfsim.views.film.png import Pixels
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.frames import Frame
from ekfsim.views.picture.look import SCREEN, STANDARD, Look, Paper
from ekfsim.views.playback.view import View

BEAM, OTHER, LAST = 0.8, 1.2, 3.2  # s that a view stays
DRIVEN = 0.4  # the same for a driven or recorded robot, whose run has thousands
ANIMATIONS = (".gif", ".mp4")
PATTERNS = "step-*.png", "frame-*.png"  # as they are called, and were in version 0.1.0
# in the pictures' names: at least, and where the length of a run is not known
DIGITS, UNKNOWN_DIGITS = 4, 6

Progress = Callable[[int], object]  # told the number of pictures made so far


def render(
    views: Iterable[View],
    scene: Scene,
    scope: Scope,
    target: Path,
    *,
    look: Look = STANDARD,
    paper: Paper = SCREEN,
    strip: Sequence[Series] = (),
    every: int = 1,
    force: bool = False,
    progress: Progress = lambda made: None,
) -> None:
    """Make a picture of every `every`-th view, and of the last; with a strip of the curves of each
    filter beneath it, where they are given.

    A target that ends in .gif or .mp4 is an animation, one without a suffix a folder of PNG
    files. Raises UsageError if the target is of another kind, exists (without `force`), or
    cannot be made here.
    """
    if every < 1:
        raise UsageError(f"every {every}th view: choose 1 or more")
    suffix = target.suffix.lower()
    if suffix not in ("", *ANIMATIONS):
        with told(target):
            suffix = "" if is_folder(target) else suffix
    if suffix in still.KINDS:
        raise UsageError(f"{target}: one picture is of one step; say which, e.g. --step 1")
    if suffix not in ("", *ANIMATIONS):
        raise UsageError(
            f"{target}: '{suffix}' is no kind of picture; "
            "name a .gif, an .mp4, an .html, or a folder for PNG files"
        )
    write_video = video.writer() if suffix == ".mp4" else None
    if suffix:
        refuse_existing(target, force)
    frame = framed(scene, scope, look, paper, strip)
    shown = _reported(thinned(views, every), progress)
    if suffix == "":
        with whole_folder(target, *PATTERNS, force=force) as folder:
            _number(folder, frame, shown, scene)
        return
    with whole_file(target, force) as path:
        if write_video is not None:
            write_video(path, _timed(frame.rgb, shown), told_in_a_line(scene))
        else:
            with path.open("wb") as file:
                gif.write(file, _timed(frame.rgba, shown), told_in_a_line(scene))


def number_of_pictures(views: int, every: int) -> int:
    """How many pictures `render` makes of so many views:
    every `every`-th, from the first, and the last.

    >>> [number_of_pictures(views, 3) for views in (1, 2, 4, 5)]
    [1, 2, 2, 3]
    """
    return 1 + -(-(views - 1) // every)


def thinned(views: Iterable[View], every: int) -> Iterator[View]:
    """Every `every`-th view, from the first, and the last."""
    for view, is_last in _lasting(views):
        if view.number % every == 0 or is_last:
            yield view


def _number(folder: Path, frame: Frame | Stripped, views: Iterable[View], scene: Scene) -> None:
    """step-0000.png, … by the views' steps, with digits enough for them to sort."""
    most = expanded_length(scene.commands)
    digits = max(DIGITS, len(str(most))) if scene.commands else UNKNOWN_DIGITS
    made_by = metadata(scene)
    for view in views:
        picture = frame.png(view, {**made_by, "View": str(view.number)})
        (folder / f"{view.named(digits)}.png").write_bytes(picture)


def _timed(
    drawn: Callable[[View], Pixels], views: Iterable[View]
) -> Iterator[tuple[Pixels, float]]:
    """The pixels of each view and how many s it stays."""
    for view, is_last in _lasting(views):
        yield drawn(view), LAST if is_last else _tempo(view)


def _tempo(view: View) -> float:
    if view.step.entry.t is not None:
        return DRIVEN
    return BEAM if view.beam else OTHER


def _reported(views: Iterable[View], progress: Progress) -> Iterator[View]:
    for made, view in enumerate(views, start=1):
        yield view
        progress(made)


def _lasting(views: Iterable[View]) -> Iterator[tuple[View, bool]]:
    """Each view, and whether it is the last."""
    coming = iter(views)
    view = next(coming, None)
    while view is not None:
        following = next(coming, None)
        yield view, following is None
        view = following
