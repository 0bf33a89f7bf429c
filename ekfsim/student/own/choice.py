"""The filter that a place stands for, as filters/choice.py asks for it."""

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.filter import OwnFilter
from ekfsim.student.own.forms import Whole
from ekfsim.student.own.loading import load
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


def own(place: str) -> Own:
    """The filter at a place. Raises UsageError where there is none, FaultError where it fails."""
    load(place)
    return Own(place)
