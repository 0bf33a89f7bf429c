"""The backends that are installed."""

from ekfsim.geometry import backend

BACKENDS = backend.BACKENDS if backend.compiles() else ("numpy",)
