"""What follows many beams, and filters and judges many runs: NumPy, or code compiled by Numba,
where that is asked for.

    backend.use("numba")

NumPy is the default even where Numba is installed: what a study answers must not depend on what
else is installed, and Numba takes a second to import and, the first time, some to compile. Both
find the same walls, and the same ranges and beliefs but for the last digits.
"""

import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal, get_args

Backend = Literal["numpy", "numba"]
BACKENDS: tuple[Backend, ...] = get_args(Backend)

_used: Backend = "numpy"


def use(backend: Backend) -> None:
    """Choose for all casts of this process that are still to come."""
    global _used
    if backend not in BACKENDS:
        raise ValueError(f"{backend!r} is no backend; there are {' and '.join(BACKENDS)}")
    if backend == "numba" and not compiles():
        raise ModuleNotFoundError(
            "numba is not installed; it comes with ekfsim's extra `fast`", name="numba"
        )
    _used = backend


def compiles() -> bool:
    """Whether Numba is installed."""
    return importlib.util.find_spec("numba") is not None


@contextmanager
def using(backend: Backend) -> Iterator[None]:
    """Choose for the casts of a block alone."""
    before = used()
    use(backend)
    try:
        yield
    finally:
        use(before)


def used() -> Backend:
    """What is in use."""
    return _used
