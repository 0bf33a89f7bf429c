"""What of a file is known to be right."""

from typing import Any

from ekfsim.errors import Mistake
from ekfsim.files.yaml.marked import Node, Path
from ekfsim.files.yaml.telling import at


class Sound:
    """A file without what is known to be wrong with it."""

    def __init__(self, file: str, root: Node, wrong: set[Path]) -> None:
        self.file = file
        self.root = root
        self.wrong: set[Path] = set()  # what is wrong itself
        self.around: set[Path] = set()  # what holds something wrong
        for path in wrong:
            self.give_up(path)

    def give_up(self, path: Path) -> None:
        """Know the value at a path as wrong, and whatever holds it or lies in it."""
        self.wrong.add(path)
        self.around.update(path[:length] for length in range(len(path)))

    def value(self, *path: str | int) -> Any:
        """The plain value at a path,
        None where there is none, or where a mistake lies in it or around it.
        """
        node = self.root.at(path)
        if (
            node is None
            or path in self.around
            or any(path[: length + 1] in self.wrong for length in range(len(path)))
        ):
            return None
        return node.plain()

    def count(self, *path: str | int) -> int:
        """The length of a list, right or wrong; 0 where there is none."""
        node = self.root.at(path)
        return len(node.value) if node and isinstance(node.value, list) else 0

    def mistake(self, path: Path, wrong: str, right: str) -> Mistake:
        """A mistake in the value at a path."""
        return at(self.file, self.root.nearest(path).mark, path, wrong, right)
