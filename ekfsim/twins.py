"""The one door between the text and what is quicker.

A function of the text that is marked `@twinned` may be stood in for by a twin: another function
that gives the same for some of its arguments, in less time. Which twins there are, and when each
may stand in, is a table, `ekfsim/fast/table.py`; the text knows nothing of it. Three ways to run
the program:

    "plain"     the text itself, whatever it takes
    "quick"     twins in plain floats and in NumPy: what is taken if nothing else is said
    "compiled"  these, and what Numba compiles: the extra `fast`

"quick" is taken even where Numba is installed: what a study answers must not depend on what else is
installed, and Numba takes a second to import and, the first time, some to compile.
"""

import importlib.util
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, Literal, ParamSpec, TypeVar, cast, get_args

P = ParamSpec("P")
R = TypeVar("R")

Way = Literal["plain", "quick", "compiled"]
WAYS: tuple[Way, ...] = get_args(Way)

_way: Way = "quick"


def take(way: Way) -> None:
    """Choose for all that this process has still to calculate.

    Raises ModuleNotFoundError where the extra `fast` is asked for and not there.
    """
    global _way
    if way not in WAYS:
        raise ValueError(f"{way!r} is no way; there are {', '.join(WAYS)}")
    if way == "compiled" and not compiles():
        raise ModuleNotFoundError(
            "numba is not installed; it comes with ekfsim's extra `fast`", name="numba"
        )
    _way = way


def taken() -> Way:
    """What is in use."""
    return _way


def compiles() -> bool:
    """Whether Numba is installed."""
    return importlib.util.find_spec("numba") is not None


@contextmanager
def taking(way: Way) -> Iterator[None]:
    """Choose for a block of code alone."""
    before = taken()
    take(way)
    try:
        yield
    finally:
        take(before)


def twinned(text: Callable[P, R]) -> Callable[P, R]:
    """A function of the text, stood in for by the first of its twins that suits the arguments.

    A twin that sees only on its way that it cannot answer returns None, and the next is asked. What
    the function does as it is written is its attribute `text`; see `as_written`.
    """
    name = f"{text.__module__}:{text.__qualname__}"
    found: dict[tuple[Way, type], tuple[Callable[..., R | None], ...]] = {}

    @wraps(text)
    def quickest(*args: P.args, **kwargs: P.kwargs) -> R:
        key = _way, type(args[0])
        twins = found.get(key)
        if twins is None:
            twins = found[key] = _twins(name, *key)
        for twin in twins:
            made = twin(*args, **kwargs)
            if made is not None:
                return made
        return text(*args, **kwargs)

    quickest.text = text  # type: ignore[attr-defined]
    return quickest


def as_written(function: Callable[P, R]) -> Callable[P, R]:
    """The text of a function that may have twins, for those who want no other."""
    text: Callable[P, R] = function.text  # type: ignore[attr-defined]
    return text


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """A function that Numba compiles at its first call, and keeps for later processes where there
    is a folder to keep it in.

    Numba throws away what it kept when the function's own file changes, and only then, though the
    functions that it calls are compiled into it. So each state of all these files has its folder.
    """
    import numba  # the extra `fast`: modules made by it alone come here

    from ekfsim.kept import folder_for

    config: Any = numba.config  # its entries are made as it is imported
    told = config.CACHE_DIR  # by whoever runs this process, for all of Numba; mostly ""
    folder = folder_for(told)
    if folder is None:
        return cast("Callable[P, R]", numba.njit(nogil=True, error_model="numpy")(function))
    config.CACHE_DIR = str(folder)  # read as a function is marked, at no other time
    try:
        made = numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    finally:
        config.CACHE_DIR = told
    return cast("Callable[P, R]", made)


def _twins(name: str, way: Way, first: type) -> tuple[Callable[..., R | None], ...]:
    """The twins of a function of this name, whose first argument is of that type."""
    if way == "plain":
        return ()
    from ekfsim.fast.table import twins_of  # when first asked for: it stands below the text

    return twins_of(name, way, first)
