"""What follows many beams, and filters and judges many runs: NumPy, or code compiled by Numba, where that is asked for.

    engine.use("numba")

NumPy is the default even where Numba is installed: what a study answers must not depend on what else is installed, and
Numba takes a second to import and, the first time, some to compile. Both find the same walls, and the same ranges and
beliefs but for the last digits.
"""

import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal, get_args

Engine = Literal["numpy", "numba"]
ENGINES: tuple[Engine, ...] = get_args(Engine)

_used: Engine = "numpy"


def use(engine: Engine) -> None:
    """Choose for all casts of this process that are still to come."""
    global _used
    if engine not in ENGINES:
        raise ValueError(f"{engine!r} is no engine; there are {' and '.join(ENGINES)}")
    if engine == "numba" and not compiles():
        raise ModuleNotFoundError("numba is not installed; it comes with ekfsim's extra `fast`", name="numba")
    _used = engine


def compiles() -> bool:
    """Whether Numba is installed."""
    return importlib.util.find_spec("numba") is not None


@contextmanager
def using(engine: Engine) -> Iterator[None]:
    """Choose for the casts of a block alone."""
    before = used()
    use(engine)
    try:
        yield
    finally:
        use(before)


def used() -> Engine:
    """What is in use."""
    return _used
