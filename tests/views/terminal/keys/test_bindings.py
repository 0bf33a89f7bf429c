import pytest

from ekfsim.views.terminal.keys.bindings import KEYS, MOST, Action, Counted, action_of
from ekfsim.views.terminal.keys.help import HELP
from ekfsim.views.terminal.keys.keyboard import NO_MORE, UNNAMED

NEXT, BACK = Action.NEXT, Action.BACK


def asked(*names):
    counted = Counted()
    return [turn for name in names if (turn := counted.press(name))]


@pytest.mark.parametrize(
    ("names", "action"),
    [
        (["n", "N", " ", "enter", "right", "down", "pagedown"], NEXT),
        (["p", "P", "backspace", "left", "up", "pageup"], BACK),
        (["q", "Q", "ctrl+d", NO_MORE], Action.QUIT),
        (["?", "h", "f1"], Action.HELP),
        (["G", "end"], Action.END),
        (["r", "home"], Action.RESTART),
        (["x", "escape", UNNAMED, "\ufffd", "/"], Action.UNKNOWN),
    ],
)
def test_what_keys_ask_for(names, action):
    assert [action_of(name) for name in names] == [action] * len(names)


def test_numbers_repeat_what_steps_and_name_a_step():
    names = "12nn3p4sn5xn0n13gg7jG"
    assert asked(*names) == [
        (NEXT, 12),
        (NEXT, 1),
        (BACK, 3),
        (Action.SAVE, 1),
        (NEXT, 1),
        (Action.UNKNOWN, 1),
        (NEXT, 1),
        (NEXT, 1),
        (Action.STEP, 13),
        (Action.STEP, 0),
        (Action.DOWN, 7),
        (Action.END, 1),
    ]


def test_a_hand_on_the_digits_costs_no_more_than_the_cap():
    assert asked(*"9" * 50, "n") == [(NEXT, MOST)]


def test_the_help_fits_any_terminal_and_tells_every_key():
    assert HELP.isascii()
    assert max(map(len, HELP.splitlines())) <= 78  # --help indents it
    told = HELP.split()
    for name in KEYS:
        if len(name) == 1 and name not in " =_":
            assert name in told or f"13{name}" in told
