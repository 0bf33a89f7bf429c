"""Where the commands of a course are kept: in a file of its own, and never over another."""

import itertools
import os
from dataclasses import dataclass
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.results.writing import special, told, whole_text
from ekfsim.files.scene_text import replay, scene_text
from ekfsim.views.driving.course import Course


@dataclass
class Saving:
    """The file of a course, rewritten as often as it is saved. Where another lies in its place, or
    it was edited meanwhile, that one stays, and a number is put behind the name.
    """

    out: Path
    force: bool = False  # whether what lies in its place may be replaced
    options: tuple[str, ...] = ()  # of the command line that shows it as it was seen
    _ours: str | None = None  # what we have written there

    def __post_init__(self) -> None:
        if self.out.suffix == ".py":
            raise UsageError(f"{self.out}: commands are no filter; name it {self.out.stem}.yaml")
        with told(self.out):
            if self.out.is_dir():
                raise UsageError(f"{self.out}: this is a folder; name a file")

    def save(self, course: Course) -> str:
        """Write all commands so far; says where, and what plays them.

        Raises UsageError or RunError where that cannot be.
        """
        scene = course.scene_so_far
        path = self._place()
        text = scene_text(scene, path, self.options)
        with whole_text(path, self.force or self._is_ours(path)) as file:
            file.write(text)
        self.out, self._ours = path, text
        course.mark_as_saved()
        n = len(course.commands)
        return f"Saved {n} command{'' if n == 1 else 's'}: {replay(scene, path, self.options)}"

    def _place(self) -> Path:
        if self.force or special(self.out) or not os.path.lexists(self.out):
            return self.out
        if self._is_ours(self.out):
            return self.out
        for n in itertools.count(2):
            path = self.out.with_name(f"{self.out.stem}-{n}{self.out.suffix}")
            if not os.path.lexists(path):
                return path
        raise AssertionError

    def _is_ours(self, path: Path) -> bool:
        """Whether what lies there is what we have written."""
        if path != self.out or self._ours is None:
            return False
        with told(path):
            return path.is_file() and path.read_bytes() == self._ours.encode()
