"""What each key asks for in `play`, in the terminal as in the window."""

from enum import Enum

from ekfsim.views.terminal.keys.keyboard import NO_MORE


class Action(Enum):
    """What a key asks for."""

    NEXT = "next"
    BACK = "back"
    RESTART = "restart"
    STEP = "go to a step"
    END = "go to the end"
    AMBIGUOUS = "go to the next ambiguous beam"
    LOST = "go to where it was lost"
    FASTER = "go on by itself, faster"
    SLOWER = "go on by itself, slower"
    EXPLAIN = "explain"
    PANES = "picture, numbers or both"
    DOWN = "scroll down"
    UP = "scroll up"
    SAVE = "save"
    WHY = "why it was lost"
    DRIVE = "drive on from here"
    HELP = "help"
    QUIT = "quit"
    UNKNOWN = "unknown"


KEYS: dict[str, Action] = {
    **dict.fromkeys(("n", " ", "enter", "right", "down", "pagedown"), Action.NEXT),
    **dict.fromkeys(("p", "backspace", "left", "up", "pageup"), Action.BACK),
    **dict.fromkeys(("r", "home"), Action.RESTART),
    "g": Action.STEP,
    **dict.fromkeys(("G", "end"), Action.END),
    "a": Action.AMBIGUOUS,
    "l": Action.LOST,
    **dict.fromkeys(("+", "="), Action.FASTER),  # one key, with Shift and without
    **dict.fromkeys(("-", "_"), Action.SLOWER),
    "e": Action.EXPLAIN,
    **dict.fromkeys(("v", "tab"), Action.PANES),
    "j": Action.DOWN,
    "k": Action.UP,
    "s": Action.SAVE,
    "w": Action.WHY,
    "d": Action.DRIVE,
    **dict.fromkeys(("?", "h", "f1"), Action.HELP),
    **dict.fromkeys(("q", "ctrl+d", NO_MORE), Action.QUIT),
}
REPEATED = (Action.NEXT, Action.BACK, Action.DOWN, Action.UP)
MOST = 9_999_999  # more digits than that are a hand resting on the keyboard


def action_of(name: str) -> Action:
    """What a key asks for, with Shift or Caps Lock what it does without where that is all it does.

    >>> action_of("n"), action_of("N"), action_of("G"), action_of("ctrl+x")
    (<Action.NEXT: 'next'>, <Action.NEXT: 'next'>, <Action.END: 'go to the end'>, \
<Action.UNKNOWN: 'unknown'>)
    """
    return KEYS.get(name) or KEYS.get(name.lower(), Action.UNKNOWN)


class Counted:
    """Digits before a key are a number: 1, 2, n is twelve times `next`, 1, 3, g is step 13.

    >>> counted = Counted()
    >>> [counted.press(name) for name in "12nn"]
    [None, None, (<Action.NEXT: 'next'>, 12), (<Action.NEXT: 'next'>, 1)]
    """

    def __init__(self) -> None:
        self.typed = 0  # the number so far, 0 where none was typed

    def press(self, name: str) -> tuple[Action, int] | None:
        """The action and its number, None while one is typed: how often for what repeats, which
        step to go to (0 where none was typed).
        """
        if name.isdecimal() and name.isascii():
            self.typed = min(10 * self.typed + int(name), MOST)
            return None
        action, number, self.typed = action_of(name), self.typed, 0
        return action, meant(action, number)


def meant(action: Action, number: int) -> int:
    """What a number means to an action: how often, or to which step; 0: none was typed."""
    if action is Action.STEP:
        return number
    return max(number, 1) if action in REPEATED else 1
