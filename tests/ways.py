"""The ways to calculate quickly that are installed here."""

from ekfsim import twins

WAYS = ("quick", "compiled") if twins.compiles() else ("quick",)
