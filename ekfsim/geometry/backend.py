"""What is compiled by Numba, or not, as rooms ask that do not yet stand in the table of twins."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal, get_args

from ekfsim import twins
from ekfsim.twins import Way
from ekfsim.twins import compiles as compiles

Backend = Literal["numpy", "numba"]
BACKENDS: tuple[Backend, ...] = get_args(Backend)
_WAYS: dict[Backend, Way] = {"numpy": "quick", "numba": "compiled"}


def use(backend: Backend) -> None:
    """Choose for all that this process has still to calculate."""
    if backend not in BACKENDS:
        raise ValueError(f"{backend!r} is no backend; there are {' and '.join(BACKENDS)}")
    twins.take(_WAYS[backend])


@contextmanager
def using(backend: Backend) -> Iterator[None]:
    """Choose for a block of code alone."""
    with twins.taking(_WAYS[backend]):
        yield


def used() -> Backend:
    """What is in use."""
    return "numba" if twins.taken() == "compiled" else "numpy"
