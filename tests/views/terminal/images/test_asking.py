import pytest

from ekfsim.views.terminal.images import asking
from ekfsim.views.terminal.images.asking import QUESTIONS, Means, Protocol, ask
from ekfsim.views.terminal.keys.keyboard import Keyboard

KITTY = b"\x1b_Gi=1;OK\x1b\\\x1b[4;480;800t\x1b[?62;c"
ITERM2 = b"\x1b]1337;Capabilities=T3LrMSc7UUw9Ts3BFGsSyHNoSx\x07\x1b[4;480;880t\x1b[?62;4c"
XTERM = b"\x1b[6;17;8t\x1b[?1;0;16S\x1b[?2;0;1000;900S\x1b[?63;1;2;4;6;9;15;22c"
TMUX = b"\x1b[?1;2c"


def asked(arriving, pixels=(0, 0)):
    """What comes of it where these bytes arrive, one by one, and then nothing more."""
    written, waiting = [], iter(arriving)

    def source(timeout):
        assert timeout <= asking.PATIENCE
        byte = next(waiting, None)
        return None if byte is None else bytes([byte])

    means, keys = ask(source, written.append, (80, 24), pixels)
    assert written == [QUESTIONS]
    return means, keys + bytes(waiting)


@pytest.mark.parametrize(
    ("answers", "means"),
    [
        (KITTY, Means(Protocol.KITTY, (10, 20))),
        (ITERM2, Means(Protocol.ITERM2, (11, 20))),
        (ITERM2 + KITTY, Means(Protocol.ITERM2, (11, 20))),  # what comes later is no answer
        (XTERM, Means(Protocol.SIXEL, (8, 17), 16, (1000, 900))),
        (b"\x1b[6;0;0t\x1b[4;240;320t\x1b[?64;4c", Means(Protocol.SIXEL, (4, 10))),
        (b"\x1b[6;20;9t\x1b[?1;3;0S\x1b[?2;1S\x1b[?64;4c", Means(Protocol.SIXEL, (9, 20))),
        (b"\x1b[6;20;9t\x1b[?1;0;99999999999S\x1b[?64;4c", Means(Protocol.SIXEL, (9, 20))),
        (b"\x1b[?64;4c", None),  # without the size of a cell it might cover the text
        (TMUX, None),
        (b"\x1b_Gi=1;ENOTSUPPORTED:no\x1b\\" + TMUX, None),
        (b"\x1b]1337;Capabilities=T3FrSx\x07" + TMUX, None),  # Fr is another feature
        (b"\x1b[6;20;9t\x1b[?4c", None),  # the first is the terminal's level
        (b"", None),
    ],
)
def test_a_terminal_draws_what_it_says_that_it_draws(answers, means):
    assert asked(answers)[0] == means


def test_the_size_may_be_known_to_the_system():
    assert asked(b"\x1b[?64;4c", (720, 384))[0] == Means(Protocol.SIXEL, (9, 16))
    assert asked(b"\x1b[6;20;10t\x1b[?64;4c", (720, 384))[0].cell == (10, 20)


def test_keys_typed_meanwhile_are_keys():
    arriving = b"n\x1b[C" + KITTY[:11] + b"12n" + KITTY[11:] + b"q"
    assert asked(arriving) == (Means(Protocol.KITTY, (10, 20)), b"n\x1b[C12nq")
    assert asked(b"\xc3\xa9\x1bOSq") == (None, b"\xc3\xa9\x1bOSq")


@pytest.mark.parametrize(
    "garbage", [b"\x1b[", b"\x1b_G;;;\x1b\\", b"\x1b[?;;c", b"\x1b[9;9t\xff\x00\x1b]1337;C=\a"]
)
def test_garbage_is_no_answer(garbage):
    assert asked(garbage)[0] is None


def test_what_was_not_used_comes_first_from_the_keyboard():
    waiting = iter([b"a", *(bytes([b]) for b in TMUX), b"b", b""])
    keyboard = Keyboard(lambda timeout: next(waiting))
    told = keyboard.lend(lambda source: ask(source, lambda text: None, (80, 24)))
    assert (told, keyboard(), keyboard(), keyboard()) == (None, "a", "b", "")


def test_a_silent_terminal_is_waited_for_no_longer(monkeypatch):
    now = iter([0.0, 0.1, 0.3, 0.6])
    monkeypatch.setattr(asking.time, "monotonic", lambda: next(now))
    waited = []
    means, keys = ask(
        lambda timeout: waited.append(round(timeout, 6)) or b"n", lambda text: None, (80, 24)
    )
    assert (means, keys, waited) == (None, b"nn", [0.4, 0.2])
