"""FILE.py, FILE.py:Name or package.module:Name → a student's code, ready to be called."""

import difflib
import hashlib
import importlib
import os
import warnings
from dataclasses import dataclass
from importlib.metadata import entry_points
from importlib.util import find_spec
from types import ModuleType
from typing import Any

from ekfsim.errors import UsageError
from ekfsim.files.yaml.telling import nearest
from ekfsim.filters import FILTERS
from ekfsim.filters.choice import GROUP
from ekfsim.filters.place import is_file, is_place, label, parts
from ekfsim.student.own.forms import Form, form_of, where
from ekfsim.student.own.home import Home, shown


@dataclass(frozen=True)
class Code:
    """A student's code: what is called of it, and where it is at home."""

    label: str  # what people see of it
    form: Form
    home: Home
    source: bytes | None = None  # its file
    module: ModuleType | None = None  # all that stands in it

    def place_of(self, function: Any) -> str:
        """file:line of one of its functions: of its only return, else of its head."""
        own = getattr(self.module, "__file__", None)
        here = where(function).rpartition(":")[0] == shown(own or "")
        return where(function, self.source if here else None) or self.label


# what `bring` made filters of, by their names, as long as this process lives
BROUGHT: dict[str, Code] = {}


def load(place: str) -> Code:
    """The code at a place, as it stands there now: it is run from its first line; or that which
    was brought under a name.

    Raises UsageError where there is no such place or no filter in it, FaultError where its code
    fails.
    """
    if place in BROUGHT:
        return BROUGHT[place]
    if not is_place(place):
        place = registered(place)
    file, name = parts(place)
    return _of_file(os.path.abspath(file), name) if is_file(place) else _of_module(file, name)


def registered(name: str) -> str:
    """The place that an installed package registered under a name. Raises UsageError."""
    places = sorted({point.value for point in entry_points(group=GROUP, name=name)})
    if len(places) > 1:
        right = f"name one of them: {' or '.join(places)}"
        raise UsageError(f"{name}: {len(places)} packages register it; {right}")
    if not places and (near := nearest(name, [*FILTERS, *BROUGHT])):
        raise UsageError(f"{name}: there is no such filter; did you mean {near!r}?")
    if not places:
        raise UsageError(
            f"{name}: there is no such filter here; one that was brought is known to its own "
            "process alone: write it to a file, and name that"
        )
    return places[0]


def _of_file(path: str, name: str) -> Code:
    source, home = _read(path), Home(os.path.dirname(path))
    # of its own, whatever another file of the same name is called
    module = ModuleType(f"own_{hashlib.sha256(path.encode()).hexdigest()[:16]}")
    module.__file__ = path
    home.modules[module.__name__] = module
    with home.entered(), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        importlib.invalidate_caches()
        try:
            exec(compile(source, path, "exec", dont_inherit=True), module.__dict__)
        except BaseException as error:
            home.blame(error, f"{shown(path)}:1")
    told = f"{shown(path)}:{name}" if name else shown(path)
    shown_as = label(f"{path}:{name}" if name else path)
    return Code(shown_as, form_of(module, name, told), home, source, module)


def _of_module(module_name: str, name: str) -> Code:
    """The code of an installed module, which is imported as ever."""
    home = Home(root=_root(module_name.partition(".")[0]))
    with home.entered():
        try:
            module = importlib.import_module(module_name)
        except ModuleNotFoundError as error:
            if not f"{module_name}.".startswith(f"{error.name}."):
                home.blame(error, module_name)
            right = "it must be installed; a file is named FILE.py or FILE.py:Name"
            raise UsageError(f"{module_name}:{name}: there is no such module; {right}") from None
        except BaseException as error:
            home.blame(error, module_name)
    place = f"{module_name}:{name}"
    return Code(place, form_of(module, name, place), home, module=module)


def _root(package: str) -> str:
    """What the paths of an installed package's files begin with; "" where there is none."""
    try:
        spec = find_spec(package)
    except (ImportError, ValueError):
        return ""
    if spec is None or spec.origin is None:
        return ""
    is_folder = spec.submodule_search_locations is not None
    return os.path.join(os.path.dirname(spec.origin), "") if is_folder else spec.origin


def _read(path: str) -> bytes:
    """The text of a file. Raises UsageError where there is none."""
    if os.path.isdir(path):
        raise UsageError(f"{shown(path)}: is a folder; name a file in it")
    try:
        with open(path, "rb") as file:
            return file.read()
    except FileNotFoundError:
        raise UsageError(f"{shown(path)}: there is no such file{_near(path)}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError(f"{shown(path)}: cannot be read: {reason}") from None


def _near(path: str) -> str:
    """Which file beside it may be meant."""
    try:
        beside = [name for name in os.listdir(os.path.dirname(path)) if name.endswith(".py")]
    except OSError:
        return ""
    near = difflib.get_close_matches(os.path.basename(path), beside, 1)
    return f"; did you mean '{near[0]}'?" if near else ""
