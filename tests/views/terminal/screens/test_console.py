import re
from functools import partial

import pytest
from scenes import scene

from ekfsim.commands import Move, Sense
from ekfsim.errors import StepError
from ekfsim.localization import play
from ekfsim.views.picture.extent import scope
from ekfsim.views.terminal.keys.bindings import Action
from ekfsim.views.terminal.player import Player
from ekfsim.views.terminal.screens.console import OTHER_SCREEN, OWN_SCREEN, Console
from ekfsim.views.terminal.screens.layout import Look

PLACE = scene(Move(1.0, 0.5), Sense(0.2), Move(0.5, 0.0))
CLEARED = "\x1b[2J"
SEQUENCES = re.compile(
    rf"({re.escape(CLEARED)}|{re.escape(OTHER_SCREEN)}|{re.escape(OWN_SCREEN)}"
    r"|\x1b\[(\d+);1H(.*?)\x1b\[K)"
)
EXTENT = scope.of(PLACE, play(PLACE))


class Terminal:
    """What a terminal shows of what is written to it."""

    def __init__(self, columns=120, rows=40):
        self.size, self.written, self.other = (columns, rows), "", False
        self.lines = [""] * rows

    def write(self, text):
        self.written += text
        for sequence, row, line in SEQUENCES.findall(text):
            if sequence == CLEARED:
                self.lines = [""] * self.size[1]
            elif row:
                self.lines[int(row) - 1] = line
            else:
                self.other = sequence == OTHER_SCREEN


def playing(terminal, *keys):
    console = Console(
        PLACE, EXTENT, 0.954, Look(False, False), terminal.write, size=lambda: terminal.size
    )
    console.enter()
    player = Player(PLACE, play(PLACE), console, lambda view: "saved", 0.954)
    waiting = iter([*keys, "q"])
    player.play(lambda timeout: next(waiting))
    return console


def test_redrawn_in_place_it_is_what_it_would_be_drawn_afresh():
    stepped, at_once = Terminal(), Terminal()
    playing(stepped, *"nnnnpp")
    playing(at_once, "2", "n", "n", "p")  # whatever is typed, the second view in the end
    assert stepped.lines == at_once.lines
    assert "view 2 of 4" in stepped.lines[-1]


def test_only_what_changed_is_written():
    terminal = Terminal()
    playing(terminal, *"nnnn")
    before = len(terminal.written)
    again = Terminal()
    playing(again, *"nnnnn")  # the run is over: nothing but the status line is another
    assert len(again.written) - before < 150
    assert "The run is over" in again.lines[-1]


def test_another_size_is_drawn_anew():
    terminal = Terminal()
    console = playing(terminal, "n")
    terminal.size, terminal.lines = (80, 24), [""] * 24
    console.refresh()
    fresh = Terminal(80, 24)
    playing(fresh, "n")
    assert terminal.lines == fresh.lines
    written = len(terminal.written)
    console.refresh()
    assert len(terminal.written) == written


def test_the_terminal_is_given_back_and_taken_again():
    terminal = Terminal()
    console = playing(terminal, "n")
    console.leave()
    console.leave()
    assert not terminal.other
    assert terminal.written.count(OWN_SCREEN) == 1
    written = len(terminal.written)
    console.refresh()  # in the background nothing is drawn
    console.wait("on the way")
    assert len(terminal.written) == written
    console.enter()
    console.refresh()
    assert terminal.other
    assert terminal.written.count(OTHER_SCREEN) == 2
    assert "view 1 of 4" in terminal.lines[-1]


def test_what_a_filter_prints_stands_below_the_numbers_of_the_step_that_it_came_with():
    terminal = Terminal()
    console = Console(
        PLACE, EXTENT, 0.954, Look(False, False), terminal.write, size=lambda: terminal.size
    )
    console.enter()

    def printing():
        for step in play(PLACE):
            print(f"made {step.entry.index}", file=console.printed)
            if step.entry.index == 3:
                raise StepError("it fails")
            yield step

    player = Player(
        PLACE, printing(), console, lambda view: "saved", 0.954, hear=console.hear
    )  # fmt: skip
    waiting = iter("nnnpppq")

    def next_key(timeout):
        seen.append(re.findall(r"made \d", " ".join(terminal.lines)))
        return next(waiting)

    seen = []
    with pytest.raises(StepError):
        player.play(next_key)
    start, move, beam, revised = ["made 0"], ["made 1"], [], ["made 2", "made 3"]
    assert seen == [start, move, beam, revised, beam, move, start]
    assert "made" not in console.farewell()  # it is told by itself


def test_what_was_read_stays_once_and_in_the_order_of_the_run():
    console = playing(Terminal(), *"nnpnnn")
    left = console.farewell()
    assert left.count("==>") == 3
    assert left.index("Commanding") < left.index("predicted range") < left.index("Verdict")


@pytest.mark.parametrize(
    ("size", "stand"),
    [((80, 24), "picture numbers both"), ((120, 40), "both picture numbers")],
)
def test_a_key_turns_the_panes(size, stand):
    def shown(times):
        terminal = Terminal(*size)
        playing(terminal, "n", *"v" * times)
        body = "".join(terminal.lines[4:-1])
        return bool(re.search("[\u2801-\u28ff]", body)), "odometry" in body

    meant = {"picture": (True, False), "numbers": (False, True), "both": (True, True)}
    assert [shown(times) for times in range(3)] == [meant[panes] for panes in stand.split()]
    assert shown(3) == shown(0)


def test_the_numbers_scroll_to_their_end_and_back():
    first, end, back = (Terminal(80, 24) for _ in range(3))
    playing(first, "3", "n", "v", *"k" * 9)
    playing(end, "3", "n", "v", *"j" * 9)
    playing(back, "3", "n", "v", *"j" * 9, *"k" * 9)
    assert any("==>" in line for line in first.lines)
    assert any("▼" in line for line in first.lines)
    assert "degrees of freedom" in " ".join(end.lines[-4:-1])
    assert any("▲" in line for line in end.lines)
    assert back.lines == first.lines


def test_how_far_a_long_way_has_come_stands_in_the_status_line_alone():
    terminal = Terminal()
    console = playing(terminal, "n")
    before = list(terminal.lines)
    console.wait("to the end: step 500 of 9000")
    assert terminal.lines == [*before[:-1], "to the end: step 500 of 9000"]
    console.arrange(Action.PANES, 1)
    playing(terminal, "n")
    assert terminal.lines == before


class Drawn:
    """Says where an image would stand, and of what."""

    def __init__(self, largest=10_000):
        self.largest = largest

    def fits(self, box):
        return box.columns * box.rows < self.largest

    def draw(self, view, box):
        return f"<{view.number} at {box.row},{box.column}: {box.columns}x{box.rows}>"

    def removed(self):
        return "<gone>"


def imaged(terminal, *keys, largest=10_000):
    console = Console(
        PLACE, EXTENT, 0.954, Look(False, False), terminal.write, size=lambda: terminal.size
    )
    console.images = Drawn(largest)
    console.enter()
    player = Player(PLACE, play(PLACE), console, lambda view: "saved", 0.954)
    waiting = iter([*keys, "q"])
    player.play(lambda timeout: next(waiting))
    return console, re.findall("<.*?>", terminal.written)


def test_an_image_stands_in_the_place_of_the_picture():
    terminal = Terminal(80, 24)
    assert imaged(terminal, "n", "7")[1] == ["<gone>", "<0 at 0,0: 79x23>", "<1 at 0,0: 79x23>"]
    assert terminal.lines[:23] == [""] * 23
    assert "step 1 of 3" in terminal.lines[23]


def test_the_numbers_beside_an_image_leave_its_cells_alone():
    terminal = Terminal(120, 30)
    _, images = imaged(terminal, "n")
    assert images[1:] == ["<0 at 0,0: 66x29>", "<1 at 0,0: 66x29>"]
    assert all(line.startswith("\x1b[66C │ ") for line in terminal.lines[:29])
    assert terminal.written.rindex("<1 at") > terminal.written.rindex("\x1b[K")


def test_where_no_image_stands_the_last_one_is_gone():
    terminal = Terminal(80, 24)
    _, images = imaged(terminal, "v", "v", "?", "n", "n")
    assert images == [
        "<gone>", "<0 at 0,0: 79x23>",  # the picture
        "<gone>",  # the numbers
        "<gone>", "<0 at 0,0: 79x12>",  # both
        "<gone>",  # the help
        "<gone>", "<1 at 0,0: 79x12>", "<2 at 0,0: 79x12>",
    ]  # fmt: skip
    assert terminal.written.count("<gone>" + CLEARED) == images.count("<gone>")


def test_a_place_too_small_for_an_image_has_characters():
    small, text = Terminal(80, 24), Terminal(80, 24)
    assert imaged(small, "n", largest=100)[1] == ["<gone>"]
    playing(text, "n")
    assert small.lines == text.lines


def test_the_image_goes_with_the_screen_and_comes_back_with_it():
    terminal = Terminal(80, 24)
    console, _ = imaged(terminal)
    console.leave()
    assert terminal.written.endswith("\x1b\\<gone>" + OWN_SCREEN)
    console.enter()
    console.refresh()
    assert terminal.written.endswith("<0 at 0,0: 79x23>")


def pressed(keys, timeout):
    return next(keys)


def test_another_run_comes_in_place_of_the_one_that_was_shown():
    terminal, fresh = Terminal(), Terminal()
    console = playing(terminal, *"nn")
    console.printed.write("of the old one")
    console.hear(1)
    other = scene(Move(2.0, 0.0), Sense(0.2))
    extent = scope.of(other, play(other))
    console.turn_to(other, extent)
    for each in (console, Console(other, extent, 0.954, Look(False, False), fresh.write,
                                  size=lambda: fresh.size)):  # fmt: skip
        each.enter()
        player = Player(other, play(other), each, lambda view: "saved", 0.954)
        player.play(partial(pressed, iter("nq")))
    assert terminal.lines == fresh.lines
    assert console.printed.getvalue() == ""
    assert console.farewell() == each.farewell()
