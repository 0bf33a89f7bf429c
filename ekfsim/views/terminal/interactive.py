"""Puts an interactive run together: what is played or driven, on the screens that there are."""

import itertools
import sys
from contextlib import redirect_stderr, suppress
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

from ekfsim.localization import play
from ekfsim.printable import in_a_line
from ekfsim.scene import Scene
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.extent.scope import Scope
from ekfsim.views.picture.look import STANDARD, Look
from ekfsim.views.playback.playback import UntilFailure
from ekfsim.views.terminal.pace import Pace
from ekfsim.views.terminal.player import Player
from ekfsim.views.terminal.stage import Stage, wants_watching, wants_window
from ekfsim.views.words.closing import conclude_all

if TYPE_CHECKING:
    from ekfsim.views.driving.course import Course
    from ekfsim.views.driving.saving import Saving
    from ekfsim.views.terminal.watching import Watch

# steps whose limits are known before the first picture; where a later one leaves them it grows
LOOK_AHEAD = 3000
DRIVEN = Path("drive.yaml")


def play_interactively(
    scene: Scene, show: str, out: Path, look: Look, force: bool, explain: bool,
    auto: float | None = None, watch: "Watch | None" = None,
) -> None:  # fmt: skip
    """Step through a scene until a key quits. show : auto, window, image, text or files;
    out : folder of saved pictures; explain : the narrative in its long form;
    auto : s after which it goes on by itself; watch : looks whether its files were saved

    Raises UsageError where a window is asked for and there is none.
    """
    wants_window(show)  # before anything takes long
    if watch is not None:
        wants_watching()
    stage = Stage.of(scene, _extent(scene, look), show, out, look, force)
    with stage.keys() as next_key:
        player = _player(scene, stage, look, explain, Pace(auto))
        player.play(next_key if watch is None else watch.keys(next_key))
        while watch is not None and watch.news:
            player = _as_saved(player, stage, watch, look)
            player.play(watch.keys(next_key))
        scene = player.scene
    if player.drives:
        from ekfsim.views.driving.course import Course
        from ekfsim.views.driving.saving import Saving

        view = player.playback.view(player.number)
        assert view is not None
        course = Course(scene, view.step.entry.index)
        drive_interactively(course, Saving(DRIVEN), show, out, look, player.explain)


def _player(scene: Scene, stage: Stage, look: Look, explain: bool, pace: Pace) -> Player:
    return Player(
        scene, play(scene), stage.screen, stage.pictures.save, look.probability, explain, pace,
        stage.interruptible, hear=stage.hear,
    )  # fmt: skip


def _as_saved(player: Player, stage: Stage, watch: "Watch", look: Look) -> Player:
    """What goes on after the files were saved: their run at the same step; or, where there is a
    mistake in them, the one that there was.
    """
    if watch.mistake:
        player.greeting, player.remark = watch.mistake, " · as it was before this was saved"
        return player
    from ekfsim.views.terminal.watching import counterpart

    scene = watch.scene
    stage.turn_to(scene, _extent(scene, look))
    fresh = _player(scene, stage, look, player.explain, player.pace)
    shown = player.playback.view(player.number)
    assert shown is not None
    meant = watch.meant if watch.meant is not None and shown is watch.shown else shown
    view = counterpart(fresh.playback, meant)
    watch.meant, watch.shown = meant, view
    fresh.number, last, index = view.number, view.step.entry.index, meant.step.entry.index
    ends = f"; there is no step {index}, the run ends at step {last}" if last < index else ""
    if fresh.playback.failure is not None:
        ends = f"; the run fails after step {last}: {in_a_line(fresh.playback.failure)}"
    fresh.greeting = "\n".join([f"Read again{ends}", *watch.remarks.splitlines()])
    return fresh


def _extent(scene: Scene, look: Look) -> Scope:
    """What the pictures of a scene show, as far as is known before the first."""
    ahead = (UntilFailure(itertools.islice(play(one), LOOK_AHEAD)) for one in scene.alone())
    with redirect_stderr(StringIO()):  # what a filter prints it prints again as it is watched
        return scopes.of_all(scene, ahead, look.probability)


def drive_interactively(
    course: "Course", saving: "Saving", show: str, out: Path, look: Look, explain: bool
) -> None:
    """Drive a course until a key quits, then tell the verdict. show, out, explain : as of play

    What was not saved is saved where something else than a key ends it.
    Raises UsageError where a window is asked for and there is none.
    """
    from ekfsim.views.terminal.driving.driver import Driver

    if look.probability != STANDARD.probability:
        saving.options = "--confidence", repr(look.probability)
    # what was driven may be undone: each view finds out by itself how far the run has gone
    extent = Scope(scopes.of_all(course.scene, course.steps, look.probability).base, last=-1.0)
    stage = Stage.of(course.scene, extent, show, out, look)
    driver = Driver(
        course.scene, (), stage.screen, stage.pictures.save, look.probability, explain,
        interruptible=stage.interruptible, course=course, saving=saving,
    )  # fmt: skip
    try:
        with stage.keys() as next_key:
            driver.play(next_key)
    except BaseException:
        if any(course.unsaved):
            with suppress(OSError):  # nobody may be there to read it
                sys.stderr.write(f"{in_a_line(driver.write())}\n")
        raise
    if stage.console is not None and driver.written:
        sys.stdout.write(f"{driver.written}\n")
    if course.failure is not None:
        raise course.failure
    sys.stdout.write(conclude_all(course.scene, course.summaries, parted=course.last.apart))
