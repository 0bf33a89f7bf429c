"""The engines that are installed."""

from ekfsim.geometry import engine

ENGINES = engine.ENGINES if engine.compiles() else ("numpy",)
