"""What stands in a cell of a notebook, made a filter that a scene can name."""

import os
import re
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any

from ekfsim.errors import UsageError
from ekfsim.filters import FILTERS
from ekfsim.filters.choice import registered, verify
from ekfsim.filters.place import absolute, is_place
from ekfsim.student.own.forms import RIGHT, STEPS, form_of
from ekfsim.student.own.home import Home
from ekfsim.student.own.loading import BROUGHT, Code

Brought = Callable[..., Any] | ModuleType | str | os.PathLike[str]


def bring(*own: Brought, name: str = "") -> str:
    """The name of a filter made of two functions or of a class, as `Scene.filter` takes it.

        mine = ekfsim.bring(predict, update, name="mine")
        mine = ekfsim.bring(MyEKF)      # a class, or a module; its own name where none is given
        mine = ekfsim.bring("mine.py")  # a file, as --filter takes it: read anew for each run
        scene = dataclasses.replace(ekfsim.load_scene("tour"), filter=mine)

    predict(x, P, u, motion) and update(x, P, z, sensor) return x, P. The filter is known by its
    name as long as this process lives; who brings another under that name, as a cell that is run
    once more does, replaces it. Worker processes know what stands in a file, and nothing of what
    stands in a cell.

    Raises UsageError where it is no filter, or where the name is that of one that comes along.
    """
    if len(own) == 1 and isinstance(own[0], str | os.PathLike):
        return _at(os.fspath(own[0]))
    if len(own) not in (1, 2):
        raise UsageError(f"bring was given {len(own)} things; {RIGHT}")
    name = name or ("" if len(own) == 2 else getattr(own[0], "__name__", "").rpartition(".")[2])
    if not re.fullmatch(r"[\w-]+", name):
        right = 'write bring(predict, update, name="mine")'
        raise UsageError(f"bring: {name!r} is no name of letters, digits and -; {right}")
    if name in (*FILTERS, *registered()):
        raise UsageError(f"bring: there is a filter {name!r} already; choose another name")
    found, part = _module(own, name)
    BROUGHT[name] = Code(name, form_of(found, part, name), _home(own[0]), module=found)
    return name


def _module(own: Sequence[Any], name: str) -> tuple[ModuleType, str]:
    """A module that holds it, and under which name; "" where that is to be found."""
    if isinstance(own[0], ModuleType):
        return own[0], ""
    module, names = ModuleType(name), ("own",) if len(own) == 1 else tuple(STEPS)
    vars(module).update(zip(names, own, strict=True))
    return module, "own" if len(own) == 1 else ""


def _at(place: str) -> str:
    """The same of a place. Raises UsageError where there is none, FaultError where it fails."""
    if not is_place(place):
        raise UsageError(f"bring: {place!r} is no place of a filter; write FILE.py or FILE.py:Name")
    verify(absolute(place))
    return absolute(place)


def _home(own: Any) -> Home:
    """Whose lines are told where the code fails: those of the file that it stands in and of those
    beside it; of a notebook, those of every cell.
    """
    part = getattr(own, "predict", own)  # of a class or a module
    code = getattr(part, "__code__", None)
    file = "" if code is None else str(code.co_filename)
    return Home(root=os.path.join(os.path.dirname(file), "") if os.path.isabs(file) else "<")
