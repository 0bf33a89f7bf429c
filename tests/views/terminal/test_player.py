import io
import itertools
from contextlib import contextmanager
from itertools import groupby

import pytest
from recordings import recording, speeds
from scenes import scene

from ekfsim.commands import Kidnap, Move, Sense
from ekfsim.diagnostics.summary import Summary
from ekfsim.errors import StepError
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.views.playback.playback import views
from ekfsim.views.terminal import player as player_module
from ekfsim.views.terminal.keys.help import HELP
from ekfsim.views.terminal.pace import Pace
from ekfsim.views.terminal.player import Player
from ekfsim.views.terminal.screens.moment import Together
from ekfsim.views.terminal.screens.stream import Stream
from ekfsim.views.words.closing import conclude
from ekfsim.views.words.narrative.long_form import WORDS
from ekfsim.views.words.narrative.narrating import narrate

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


@pytest.mark.parametrize(("held", "stay"), [("Gnnnnn", 3), ("pppp", 2), ("GnnE5nn?n", 8)])
def test_a_key_held_where_it_does_nothing_draws_the_screen_once(held, stay):
    assert len(moments(*held)) == stay


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


def went(*keys, place=PLACE):
    """The view that the last key led to, and what was said of it."""
    last = moments(*"".join(keys), place=place)[-1]
    return last.view.number, last.note


def test_g_goes_to_a_step_to_the_beam_of_a_reading_and_alone_to_the_start():
    assert went("1g") == (1, "")
    assert went("2g") == (2, "")
    assert went("3g") == (4, "")
    assert went("G", "2g") == (2, "")
    assert went("nn", "g") == (0, "")


def test_beyond_the_end_it_goes_to_the_end_and_says_so():
    assert went("13g") == (4, "There is no step 13: the run ends at step 3")
    assert went("G") == (4, "")
    assert went("Gn") == (4, OVER.rstrip())


def test_a_way_by_steps_is_told_as_such_in_a_pipe():
    shown, told = played(*"3gg")
    assert shown == [0, 4, 0]
    assert told.startswith(story(0) + f"<==On to {at(4)}\n\n" + story(4))
    assert told.endswith(f"<==Back at {at(0)}\n\n" + story(0))


def ambiguous(view):
    return view.beam and bool(view.step.remark.ambiguous)


def test_a_goes_from_one_ambiguous_beam_to_the_next():
    tour = load_scene("tour")
    beams = [view.number for view in views(play(tour)) if ambiguous(view)]
    assert beams
    for many, number in enumerate(beams, start=1):
        assert went("a" * many, place=tour) == (number, "")
    none = "No beam is ambiguous from here on"
    assert went("a" * (len(beams) + 1), place=tour) == (beams[-1], none)


def test_l_goes_to_where_the_filter_was_lost():
    carried = scene(Move(1.0, 0.5), Sense(0.2), Kidnap(3.0, 1.0, 2.0), Sense(0.1), Move(0.1, 0.0))
    every = list(views(play(carried)))
    since = every[-1].judged.lost_from
    number, note = went("l", place=carried)
    assert every[number].step.entry.index == since
    assert every[number].judged.lost_from == since
    assert every[number - 1].judged.lost_from is None
    assert note == f"Lost since step {since}, up to the end"
    assert went("nl") == (1, "The filter is not lost at the end")


def test_back_at_the_revised_estimate_what_its_beam_told_is_there_as_well():
    revised = moments(*"Gp")[-1]
    assert (revised.before, revised.narrative) == (story(2), story(3))
    assert moments(*"Gpp")[-1].before == ""


def test_the_help_is_scrolled_and_left_by_any_other_key():
    pages = [bool(moment.page) for moment in moments(*"?jkn")]
    assert pages == [False, True, True, True, False]


def test_the_number_that_is_typed_is_seen():
    assert [moment.typed for moment in moments(*"12p")] == [0, 1, 12, 0]


class Ticking:
    """Time passes without a key where None is given."""

    def __init__(self, *keys):
        self.keys, self.waits = iter([*keys, QUIT]), []

    def __call__(self, timeout):
        self.waits.append(timeout)
        return next(self.keys)


def ticked(*keys, auto=None):
    screen, ticking = Screen(), Ticking(*keys)
    Player(PLACE, play(PLACE), screen, lambda view: "", 0.954, pace=Pace(auto)).play(ticking)
    return screen.moments, ticking.waits


def test_it_goes_on_by_itself_until_a_key_that_steps_or_the_end():
    shown, waits = ticked(None, None, "p", None, auto=0.5)
    assert [m.view.number for m in shown] == [0, 1, 2, 1, 2]
    assert all(wait <= 0.5 for wait in waits[:3])
    assert waits[3] is None  # after p it waits for keys
    shown, waits = ticked(*[None] * 5, auto=0.5)
    assert [m.view.number for m in shown] == [0, 1, 2, 3, 4, 4]
    assert waits[-1] is None
    assert shown[-1].note == OVER.rstrip()


def test_plus_and_minus_change_the_pace_and_space_pauses():
    shown, waits = ticked("+", "+", "-", "-", " ", "+")
    paces = [wait and round(wait + 0.05, 1) for wait in waits]
    assert paces == [None, 2.0, 1.0, 2.0, 5.0, None, 5.0]
    assert [m.view.number for m in shown] == [0] * 7
    assert "every 2 s" in shown[1].place
    assert "every" not in shown[5].place


def test_ctrl_c_stops_a_long_way_and_nothing_else():
    @contextmanager
    def pressed():
        asked = iter([False, False, True])
        yield lambda: next(asked)

    screen, waiting = Screen(), iter("nGq")
    player = Player(PLACE, play(PLACE), screen, lambda view: "", 0.954, interruptible=pressed)
    player.play(lambda timeout: next(waiting))
    last = screen.moments[-1]
    assert last.view.number == 1
    assert last.note == "Stopped on the way; Ctrl-C again ends the program"


def test_a_long_way_tells_how_far_it_has_come(monkeypatch):
    monkeypatch.setattr(player_module, "OFTEN", -1.0)
    said = []
    screen, waiting = Screen(), iter("Gq")
    screen.wait = said.append
    Player(PLACE, play(PLACE), screen, lambda view: "", 0.954).play(lambda timeout: next(waiting))
    assert said[0] == "to the end: step 0 of 3 · Ctrl-C stops"
    assert len(said) == 5


def test_where_a_run_fails_its_last_view_says_so_without_a_key_more():
    def failing():
        yield from itertools.islice(play(PLACE), 2)
        raise StepError("too far")

    screen, waiting = Screen(), iter("nq")
    player = Player(PLACE, failing(), screen, lambda view: "", 0.954)
    with pytest.raises(StepError, match="too far"):
        player.play(lambda timeout: next(waiting))
    assert [moment.note[:15] for moment in screen.moments] == ["", "The run failed "]
    assert "The run failed: too far" in screen.moments[-1].narrative


def test_w_tells_why_in_place_of_the_run_until_the_next_key():
    place = load_scene("diverge-02b-laser-overtrusted")
    waited = []
    screen = Screen()
    screen.wait = waited.append
    keys = iter("wjn" + QUIT)
    player = Player(place, play(place), screen, lambda view: "", 0.954)
    player.play(lambda timeout: next(keys))
    _, why, scrolled, gone_on = screen.moments
    assert "Lost since step 80" in why.page
    assert why.page_name.startswith("why: ")
    assert (scrolled.page, scrolled.page_name) == (why.page, why.page_name)
    assert (gone_on.page, gone_on.view.number) == ("", 1)
    assert waited[0].startswith("calculating why")


def test_ctrl_c_stops_asking_why_and_not_the_program():
    @contextmanager
    def pressed():
        yield lambda: True

    place = load_scene("diverge-02b-laser-overtrusted")
    screen, keys = Screen(), iter("wn" + QUIT)
    screen.wait = lambda note: None
    player = Player(
        place, play(place), screen, lambda view: "", 0.954, interruptible=pressed
    )  # fmt: skip
    player.play(lambda timeout: next(keys))
    assert not screen.moments[1].page
    assert "Stopped" in screen.moments[1].note
    assert screen.moments[2].view.number == 1
