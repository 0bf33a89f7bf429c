"""Scenes whose mechanism is known and that no packaged input holds: what `ekfsim why` is tried on.

rooms.py  where they play and what routes are made of
sound.py, told.py, faults.py, traps.py, strangers.py  the scenes, by what is wrong
cases.py  a case, its cause shown by taking it out, and the run that is looked at
"""

from collections.abc import Iterator

from .cases import Case
from .faults import faults_cases
from .sound import sound_cases
from .strangers import strangers_cases
from .told import told_cases
from .traps import traps_cases


def cases() -> Iterator[Case]:
    """All of them."""
    yield from sound_cases()
    yield from told_cases()
    yield from faults_cases()
    yield from traps_cases()
    yield from strangers_cases()
