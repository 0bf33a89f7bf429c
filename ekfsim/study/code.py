"""The code of filters of one's own: what a study was made by, and what repeats it."""

import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Generic, NamedTuple, Self, TypeVar

from ekfsim.errors import RunError
from ekfsim.filters.choice import code_of
from ekfsim.filters.place import is_file, label

T_co = TypeVar("T_co", covariant=True)


def digests(filters: Iterable[str]) -> dict[str, str]:
    """The code of each filter of one's own as a word, by its file's contents and those of the
    modules beside it that it imports: what differs in them makes another study.
    """
    found = {}
    for filter in filters:
        if held := code_of(filter):
            whole = hashlib.sha256()
            for name, contents in sorted(held.items()):
                whole.update(b"%d %d " % (len(name.encode()), len(contents)))
                whole.update(name.encode() + contents)
            found[filter] = whole.hexdigest()[:16]
    return found


@dataclass(frozen=True)
class OfSameCode(Generic[T_co]):
    """A block that is made by the code that its study began with, wherever that is called."""

    block: Callable[[int, int], T_co]
    codes: Mapping[str, str]  # of `digests`

    def __call__(self, first: int, runs: int) -> T_co:
        """The block. Raises RunError where the code is another now, or here."""
        now = digests(self.codes)
        for filter, code in self.codes.items():
            if now.get(filter) != code:
                raise RunError(
                    f"{label(filter)}: is not what it was when the study began; begin it anew with "
                    "--force"
                )
        return self.block(first, runs)


def of_same_code(
    block: Callable[[int, int], T_co], codes: Mapping[str, str]
) -> Callable[[int, int], T_co]:
    """A block that watches over the code that it is made by, where there is some to watch over."""
    return OfSameCode(block, codes) if codes else block


class Copies(NamedTuple):
    """The code of filters as it is laid beside a study file that repeats a study."""

    files: Mapping[str, bytes]  # by their names there
    names: Mapping[str, str]  # how the study file names each filter

    @classmethod
    def of(cls, filters: Iterable[str]) -> Self:
        """Of these filters. A file that another of its name is in the way of is named where it
        lies.
        """
        files, names = dict[str, bytes](), dict[str, str]()
        for filter in filters:
            held = code_of(filter) if is_file(filter) else {}
            fits = all(files.get(name, contents) == contents for name, contents in held.items())
            files |= held if fits else {}
            names[filter] = label(filter) if held and fits else filter
        return cls(files, names)
