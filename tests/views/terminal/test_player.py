import io
from itertools import groupby

import pytest
from recordings import recording, speeds
from scenes import scene

from ekfsim.commands import Move, Sense
from ekfsim.diagnostics.summary import Summary
from ekfsim.localization import play
from ekfsim.views.playback.playback import views
from ekfsim.views.terminal.keys.help import HELP
from ekfsim.views.terminal.player import Player
from ekfsim.views.terminal.screens.moment import Together
from ekfsim.views.terminal.screens.stream import Stream
from ekfsim.views.words.closing import conclude
from ekfsim.views.words.long_form import WORDS
from ekfsim.views.words.narrative import narrate

NEXT, BACK, QUIT, RESTART, SAVE, EXPLAIN = "npqrse"
PLACE = scene(Move(1.0, 0.5), Sense(0.2), Move(0.5, 0.0))  # five views
VIEWS = list(views(play(PLACE)))
OVER = "The run is over: q quits, p goes back, r starts again\n"


def story(*numbers):
    return "".join(narrate(VIEWS[n], PLACE) for n in numbers)


class Screen:
    """Keeps every moment."""

    keeps = False

    def __init__(self):
        self.moments = []

    def show(self, moment):
        self.moments.append(moment)

    def arrange(self, action, count):
        return ""

    def wait(self, note):
        raise AssertionError("none of these ways is long")


def moments(*keys, place=PLACE):
    """What a screen is to show after each of the keys."""
    screen, waiting = Screen(), iter([*keys, QUIT])
    player = Player(place, play(place), screen, lambda view: f"saved view {view.number}", 0.954)
    player.play(lambda timeout: next(waiting))
    return screen.moments


def played(*keys, place=PLACE):
    """Which views were drawn, and what a pipe was told."""
    screen, out, waiting = Screen(), io.StringIO(), iter([*map(str, keys), QUIT])
    screens = Together([Stream(out, None), screen])
    player = Player(place, play(place), screens, lambda view: f"saved view {view.number}", 0.954)
    player.play(lambda timeout: next(waiting))
    return [n for n, _ in groupby(m.view.number for m in screen.moments)], out.getvalue()


def at(number, of=PLACE):
    steps = [0, 1, 2, 2, 3]
    return f"step {steps[number]} of 3, view {number} of 4"


def back(number):
    return f"<==Back at {at(number)}\n\n" + story(number)


def test_the_first_view_is_shown_before_any_key():
    assert played() == ([0], story(0))


def test_next_tells_and_shows_one_view():
    assert played(NEXT) == ([0, 1], story(0, 1))
    assert played(NEXT, NEXT) == ([0, 1, 2], story(0, 1, 2))


def test_the_last_view_brings_the_verdict():
    shown, told = played(NEXT, NEXT, NEXT, NEXT)
    assert shown == [0, 1, 2, 3, 4]
    assert told.startswith(story(0, 1, 2, 3, 4))
    assert told.removeprefix(story(0, 1, 2, 3, 4)).splitlines()[-1].startswith("Verdict: ")


def test_the_verdict_is_that_of_the_whole_run():
    summary = Summary()
    for step in play(PLACE):
        summary.add(step)
    assert played(*[NEXT] * 4)[1] == story(0, 1, 2, 3, 4) + conclude(summary)
    assert played(NEXT, BACK, NEXT, NEXT, BACK, BACK, NEXT, NEXT, NEXT, NEXT)[1].endswith(
        conclude(summary)
    )


def test_nothing_comes_after_the_last_view():
    shown, told = played(*[NEXT] * 6)
    assert shown == [0, 1, 2, 3, 4]
    assert told.endswith(OVER)
    assert told.count(OVER) == 1  # however long the key is held
    assert played(*[NEXT] * 6, BACK, *[NEXT] * 3)[1].count(OVER) == 2


def test_back_shows_and_tells_the_view_before():
    shown, told = played(NEXT, NEXT, BACK)
    assert shown == [0, 1, 2, 1]
    assert told == story(0, 1, 2) + back(1)


def test_forward_again_is_told_again():
    shown, told = played(NEXT, BACK, NEXT)
    assert shown == [0, 1, 0, 1]
    assert told == story(0, 1) + back(0) + story(1)


def test_before_the_first_view_there_is_none():
    shown, told = played(BACK, BACK)
    assert shown == [0]
    assert told == story(0) + "This is the start: n goes on, q quits\n"


def test_a_number_repeats_and_shows_only_where_it_ends():
    shown, told = played(3, NEXT)
    assert shown == [0, 3]
    assert told == story(0, 1, 2, 3)
    assert played(3, NEXT, 2, BACK)[0] == [0, 3, 1]
    assert played(1, 2, NEXT)[0] == [0, 4]
    assert played(NEXT, 9, BACK)[0] == [0, 1, 0]


def test_the_long_form_is_told_from_this_view_on_until_the_key_is_pressed_again():
    def long(*numbers):
        every = list(views(play(PLACE)))
        return "".join(narrate(every[number], PLACE, explain=True) for number in numbers)

    begun, ended = (
        f"The narrative in its {form} form, from this view on:\n" for form in ("long", "short")
    )
    shown, told = played(NEXT, EXPLAIN, NEXT, EXPLAIN, NEXT)
    assert shown == [0, 1, 2, 3]
    assert told == story(0, 1) + begun + long(1, 2) + ended + story(2, 3)


def test_restart_goes_back_to_the_start():
    shown, told = played(2, NEXT, RESTART, NEXT)
    assert shown == [0, 2, 0, 1]
    assert told == story(0, 1, 2) + back(0) + story(1)


def test_save_says_where():
    shown, told = played(NEXT, SAVE)
    assert shown == [0, 1]
    assert told.endswith("saved view 1\n")


@pytest.mark.parametrize(
    ("key", "line"),
    [
        ("?", f"{HELP}\n\n{WORDS}"),
        ("x", "That key does nothing here; ? shows those that do"),
    ],
)
def test_other_keys(key, line):
    assert played(key) == ([0], f"{story(0)}{line}\n")


def test_quit_ends_at_once():
    assert played(QUIT, NEXT) == ([0], story(0))


def test_a_scene_without_commands_is_over_when_it_begins():
    shown, told = played(NEXT, place=scene())
    assert shown == [0]
    assert "Verdict: no evidence" in told
    assert told.endswith(OVER)


@pytest.mark.parametrize("place", [recording(), speeds(450, 60), speeds(7, 100)])
def test_a_recorded_run_is_stepped_through_and_summed_up_whole(place):
    seen, summary = list(views(play(place))), Summary.of(place)
    for step in play(place):
        summary.add(step)
    shown, told = played(*[NEXT] * (len(seen) - 1), place=place)
    assert shown == list(range(len(seen)))
    assert told == "".join(narrate(view, place) for view in seen) + conclude(summary)
    assert summary.steps == len(place.log.entries) - 1
    assert played(*[NEXT] * (len(seen) - 1), BACK, NEXT, place=place)[1].endswith(conclude(summary))
