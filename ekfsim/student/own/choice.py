"""The filter that a place stands for, as filters/choice.py asks for it."""

import os
import sys
from contextlib import nullcontext, redirect_stderr
from dataclasses import dataclass
from functools import partial
from io import StringIO
from pathlib import Path

from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.student.own import loading
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.filter import OwnFilter
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.home import NOWHERE
from ekfsim.student.own.loading import Code, load
from ekfsim.student.own.whole import WholeFilter


@dataclass(frozen=True)
class Own:
    """A filter of one's own, loaded anew for each run that it begins."""

    place: str

    @property
    def remark(self) -> str:
        """Of its filters. Raises UsageError or FaultError where there are none."""
        form = quietly(self.place).form
        return OwnFilter.remark if not isinstance(form, Whole) else WholeFilter.remark

    def begin(self, beginning: Beginning) -> Filter:
        """The filter for a run that begins so; of many runs nothing is heard of what they print.

        Raises UsageError or FaultError.
        """
        many = beginning.runs is not None
        with redirect_stderr(NOWHERE) if many else nullcontext():
            code = load(self.place)
        code.home.mute = many
        if isinstance(code.form, Whole):
            return WholeFilter.around(code, code.form, beginning)
        return OwnFilter.around(partial(InProcess, code), beginning)


def quietly(name: str) -> Code:
    """The code at a place, or that of a registered name. What it prints as it is loaded it prints
    again as its run begins.

    Raises UsageError where there is none, FaultError where it fails.
    """
    printed = StringIO()
    try:
        with redirect_stderr(printed):
            return load(name)
    except BaseException:
        sys.stderr.write(printed.getvalue())
        raise


def brought() -> list[str]:
    """The names of the filters that `bring` made in this process."""
    return list(loading.BROUGHT)


def contents(name: str) -> dict[str, bytes]:
    """The file at a place, and the modules beside it that it imports, by their names from its
    folder; of an installed one its package, as far as it is imported. Raises what `quietly` does.
    """
    home = quietly(name).home
    modules = home.modules if home.folder else sys.modules
    below = os.path.join(home.folder, "") if home.folder else home.root
    files = {getattr(module, "__file__", None) or "" for module in list(modules.values())}
    return {
        os.path.relpath(file, os.path.dirname(below)): Path(file).read_bytes()
        for file in sorted(files)
        if file.startswith(below)
    }
