"""The filter that a place stands for, as filters/choice.py asks for it."""

import sys
from contextlib import redirect_stderr
from dataclasses import dataclass
from functools import partial
from io import StringIO
from typing import ClassVar

from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.filter import OwnFilter
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.loading import load
from ekfsim.student.own.loading import registered_names as registered_names
from ekfsim.student.own.whole import WholeFilter


@dataclass(frozen=True)
class Own:
    """A filter of one's own, loaded anew for each run that it begins."""

    remark: ClassVar[str] = OwnFilter.remark
    place: str

    def begin(self, beginning: Beginning) -> Filter:
        """The filter for a run that begins so. Raises UsageError or FaultError."""
        code = load(self.place)
        if isinstance(code.form, Whole):
            return WholeFilter.around(code, beginning)
        return OwnFilter.around(partial(InProcess, code), beginning)


def own(name: str) -> Own:
    """The filter at a place, or that of a registered name. What it prints as it is loaded it prints
    again as its run begins.

    Raises UsageError where there is none, FaultError where it fails.
    """
    printed = StringIO()
    try:
        with redirect_stderr(printed):
            load(name)
    except BaseException:
        sys.stderr.write(printed.getvalue())
        raise
    return Own(name)
