"""What each key asks for while a run is driven; all others do what they do in `play`."""

from dataclasses import dataclass
from enum import Enum


class Order(Enum):
    """What a key asks for that `play` does not know."""

    FORWARD = "forward"
    BACKWARD = "backward"
    LEFT = "left"
    RIGHT = "right"
    BEAM = "beam"
    SHORTER = "shorter"
    LONGER = "longer"
    NARROWER = "narrower"
    WIDER = "wider"
    UNDO = "undo"
    REDO = "redo"
    WRITE = "write"
    FROM_HERE = "from here"


KEYS: dict[str, Order] = {
    **dict.fromkeys(("up", "f"), Order.FORWARD),
    **dict.fromkeys(("down", "x"), Order.BACKWARD),
    **dict.fromkeys(("left", "<"), Order.LEFT),
    **dict.fromkeys(("right", ">"), Order.RIGHT),
    "b": Order.BEAM,
    "[": Order.SHORTER,
    "]": Order.LONGER,
    "{": Order.NARROWER,
    "}": Order.WIDER,
    "u": Order.UNDO,
    **dict.fromkeys(("U", "ctrl+r"), Order.REDO),
    "w": Order.WRITE,
    "d": Order.FROM_HERE,
}
LONGEST = 12  # characters of a number: more are a hand resting on the keyboard


@dataclass
class Typed:
    """The number before a key, with its sign and its point.

    >>> typed = Typed()
    >>> [typed.take(name) for name in ("-", "4", "5", "b")], typed.text
    ([True, True, True, False], '-45')
    """

    text: str = ""

    def take(self, name: str) -> bool:
        """Whether a key belongs to the number."""
        name = "." if name == "," else name
        if name == "backspace" and self.text:
            self.text = self.text[:-1]
        elif name == "escape" and self.text:
            self.text = ""
        elif name == "-":  # its sign, whenever it comes
            self.text = self.text.removeprefix("-") if "-" in self.text else f"-{self.text}"
        elif self._goes_on_with(name):
            self.text = (self.text + name)[:LONGEST]
        else:
            return False
        return True

    def _goes_on_with(self, name: str) -> bool:
        if name == ".":
            return "." not in self.text
        return len(name) == 1 and name in "0123456789"

    def end(self) -> float | None:
        """The number, which is used up; None where none was typed."""
        text, self.text = self.text, ""
        return float(text) if text.strip("-.") else None
