"""The ways to calculate quickly that are installed here."""

from ekfsim import twins

BACKENDS = ("quick", "compiled") if twins.compiles() else ("quick",)
