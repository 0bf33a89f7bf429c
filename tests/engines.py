"""The engines that are installed, and how to use one for a while."""

import importlib.util
from contextlib import contextmanager

from ekfsim.geometry import engine

ENGINES = engine.ENGINES if importlib.util.find_spec("numba") else ("numpy",)


@contextmanager
def using(name):
    engine.use(name)
    try:
        yield
    finally:
        engine.use("numpy")
