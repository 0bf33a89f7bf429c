"""Where a filter of one's own is found: the text of its place, and what people see of it.

A scene names its filter by a text: the name of a built-in one, or a place. In a place the path of a
file is absolute, so that whoever calculates in another folder finds it too. Behind either may stand
"-smoothed": what the filter believes is then smoothed, see ekfsim/smoothing/.
"""

import os
import re
from collections.abc import Sequence

from ekfsim.filters import FILTERS

FILE = re.compile(r"(?P<file>.*\.py)(?::(?P<name>\w*))?", re.DOTALL)
SMOOTHED = "-smoothed"
MODULE = re.compile(r"(?P<module>[^\W\d][\w.]*):(?P<name>[^\W\d][\w.]*)")


def forward(filter: str) -> str:
    """The filter alone, whether what it believes is to be smoothed or not.

    >>> forward("ekf-smoothed"), forward("ekf")
    ('ekf', 'ekf')
    """
    return filter.removesuffix(SMOOTHED)


def is_smoothed(filter: str) -> bool:
    """Whether what it believes is to be smoothed."""
    return filter.endswith(SMOOTHED)


def with_smoothed(filters: Sequence[str]) -> tuple[str, ...]:
    """Filters, and behind each the same smoothed, where it does not stand there already.

    >>> with_smoothed(["ekf", "pf"])
    ('ekf', 'ekf-smoothed', 'pf', 'pf-smoothed')
    """
    both = (name for one in filters for name in (one, forward(one) + SMOOTHED))
    return tuple(dict.fromkeys(both))


def is_place(text: str) -> bool:
    """Whether a text is the place of a filter: FILE.py, FILE.py:Name or package.module:Name.

    >>> [is_place(text) for text in ("mine.py", "mine.py:MyEKF", "my.filters:MyEKF", "ekf")]
    [True, True, True, False]
    """
    alone = forward(text)
    return bool(FILE.fullmatch(alone) or MODULE.fullmatch(alone))


def parts(place: str) -> tuple[str, str]:
    """The file or the module of a place, and the name in it, "" where it tells none.

    >>> parts("/home/anna/mine.py:MyEKF"), parts("mine.py"), parts("my.filters:MyEKF")
    (('/home/anna/mine.py', 'MyEKF'), ('mine.py', ''), ('my.filters', 'MyEKF'))
    """
    alone = forward(place)
    found = FILE.fullmatch(alone)
    if found:
        return found["file"], found["name"] or ""
    module, _, name = alone.partition(":")
    return module, name


def is_file(place: str) -> bool:
    """Whether it is a file's place, not that of an installed module."""
    return FILE.fullmatch(forward(place)) is not None


def absolute(place: str) -> str:
    """The same place, its file told from the root."""
    if not is_file(place):
        return place
    file, name = parts(place)
    path = os.path.abspath(os.path.expanduser(file))
    return (f"{path}:{name}" if name else path) + place.removeprefix(forward(place))


def label(filter: str) -> str:
    """What people see of a filter, built-in or not.

    >>> label("/home/anna/mine.py"), label("/home/anna/mine.py:MyEKF"), label("ekf")
    ('mine.py', 'mine.py:MyEKF', 'ekf')
    """
    if not is_file(filter):
        return filter
    file, name = parts(filter)
    behind = filter.removeprefix(forward(filter))
    return os.path.basename(file) + (f":{name}" if name else "") + behind


def stem(filter: str) -> str:
    """The same in the name of a file, and another than that of any built-in one.

    >>> stem("/home/anna/mine.py:MyEKF"), stem("my.filters:MyEKF"), stem("ekf"), stem("ekf.py")
    ('mine-MyEKF', 'my.filters-MyEKF', 'ekf', 'ekf-own')
    """
    if not is_file(filter):
        return filter.replace(":", "-")
    file, name = parts(filter)
    own = os.path.basename(file).removesuffix(".py") + (f"-{name}" if name else "")
    own = f"{own}-own" if own in FILTERS else own
    return own + filter.removeprefix(forward(filter))
