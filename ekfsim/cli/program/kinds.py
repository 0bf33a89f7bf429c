"""What an option accepts: numbers, words and names, and how each is refused."""

import math
from pathlib import Path
from typing import Any

import click

from ekfsim.seeds import MOST_SEED, REPEATS


class Whole(click.IntRange):
    """A whole number of a range; what is none is told by a word that a person knows."""

    name = "integer"


class Seed(Whole):
    """A seed. One that is too large is told why it is."""

    def __init__(self) -> None:
        super().__init__(0, MOST_SEED)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """A whole number. Fails beyond the largest, with the reason, and for what is no seed."""
        seed = click.INT.convert(value, param, ctx)
        if seed > MOST_SEED:
            self.fail(
                f"{seed} is too large: {REPEATS}; choose one from 0 to {MOST_SEED}.", param, ctx
            )
        return super().convert(value, param, ctx)


class Word(click.Choice[str]):
    """One of a few words."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The word. Fails for another, and tells the one that it nearly is."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as refusal:
            from difflib import get_close_matches

            if near := get_close_matches(str(value).lower(), map(str, self.choices), 1):
                self.fail(f"{refusal.message.rstrip('.')}; did you mean {near[0]!r}?", param, ctx)
            raise


class Source(click.Path):
    """The name of something that is to be read. Its reader finds out whether it may be."""

    def __init__(self) -> None:
        super().__init__(readable=False)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """A name. Fails for the empty one of an unset variable, which would be the folder here."""
        if value == "":
            self.fail("the name is empty.", param, ctx)
        return super().convert(value, param, ctx)


class _Number(click.FloatRange):
    """A number of a range. nan lies in none, and outside of none."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """A float. Fails for nan, too."""
        number = float(super().convert(value, param, ctx))
        if math.isnan(number):
            self.fail(f"{value} is not in the range {self._describe_range()}.", param, ctx)
        return number


class Pace(_Number):
    """How many seconds something takes."""

    def __init__(self) -> None:
        super().__init__(0, 3600, min_open=True)


class Metres(_Number):
    """A distance, or none."""

    def __init__(self) -> None:
        super().__init__(0, 1e6)


class Probability(_Number):
    """A number between 0 and 1, and neither of them."""

    def __init__(self) -> None:
        super().__init__(0, 1, min_open=True, max_open=True)


class Share(_Number):
    """How much of something: more than none, and at most all."""

    def __init__(self) -> None:
        super().__init__(0, 1, min_open=True)


class Gate(Probability):
    """A probability, or "off"."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """A float, or "off". Fails for anything else."""
        return value if value == "off" else super().convert(value, param, ctx)


class Area(click.ParamType):  # type: ignore[type-arg]  # takes one in newer clicks alone
    """A rectangle of the plane."""

    name = "area"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float, float, float]:
        """Left, bottom, right and top in m. Fails for what is no rectangle."""
        try:
            x, y, width, height = map(float, str(value).split(","))
        except ValueError:
            x = y = width = height = math.nan
        area = x, y, x + width, y + height
        if (
            not all(map(math.isfinite, area))
            or width <= 0
            or height <= 0
            or not (area[0] < area[2] and area[1] < area[3])
        ):
            self.fail(
                f"{value!r} is no part of the plane; write X,Y,W,H: the lower left corner, then "
                "how wide and how high, in m, e.g. 0,0,4,3",
                param, ctx,
            )  # fmt: skip
        return area


class StepNumber(click.ParamType):  # type: ignore[type-arg]  # as above
    """The number of a step; with a b for the beam of a reading."""

    name = "step"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, bool]:
        """The number, and whether the beam is wanted. Fails for what is none."""
        digits = str(value).removesuffix("b")
        if not (digits.isascii() and digits.isdecimal() and len(digits) < 19):
            self.fail(f"{value!r} is no step; write its number, or 13b for the beam of 13",
                      param, ctx)  # fmt: skip
        return int(digits), digits != value


class Result(click.Path):
    """Where a result is to be written."""

    def __init__(self) -> None:
        super().__init__(path_type=Path, readable=False)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """A path. Fails for what an unset variable leaves, and for other programs' dash."""
        if value == "":
            self.fail("the name is empty.", param, ctx)
        if value == "-":
            self.fail("'-' names no file; /dev/stdout is the standard output.", param, ctx)
        return super().convert(value, param, ctx)
