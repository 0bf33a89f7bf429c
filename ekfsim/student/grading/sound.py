"""Whether a homework can be graded at all: its reference is what it is to be, before anybody is
held against it.
"""

from collections.abc import Iterator

from ekfsim.errors import InputError, Mistake
from ekfsim.files.homework import Homework
from ekfsim.files.keys.homework import HonestyKeys, JacobiansKeys
from ekfsim.files.source import as_written
from ekfsim.files.yaml.marked import Path
from ekfsim.files.yaml.parsing import parse
from ekfsim.files.yaml.telling import at
from ekfsim.student.grading.bench import Bench
from ekfsim.student.grading.parts.honesty import (
    condemned_at_end,
    condemned_on_the_way,
    of_reference,
    words,
)
from ekfsim.student.grading.parts.jacobians import has_points


def refuse_unsound(homework: Homework) -> None:
    """Raise InputError where an honest filter would be condemned, or a derivative is nowhere asked
    for: no submission could have those points.
    """
    if mistakes := list(_mistakes(homework)):
        raise InputError(mistakes)


def _mistakes(homework: Homework) -> Iterator[Mistake]:
    file, bench = str(homework.path), Bench(homework)
    root, _ = parse(as_written(homework.path, file), file)
    for n, part in enumerate(homework.keys.parts):
        match part.asks_for:
            case HonestyKeys() as keys:
                for k, told in _dishonest(keys, bench):
                    path: Path = ("parts", n, "honesty", "scenes", k)
                    yield at(file, root.nearest(path).mark, path, told, "choose another scene")
            case JacobiansKeys() as keys:
                for k, told in _nowhere(keys, bench):
                    path = ("parts", n, "jacobians", "functions", k)
                    yield at(file, root.nearest(path).mark, path, told, "name another scene")


def _dishonest(keys: HonestyKeys, bench: Bench) -> Iterator[tuple[int, str]]:
    """The scenes, by their places, in which the reference is condemned; and why."""
    for k, name in enumerate(keys.scenes):
        verdict = of_reference(bench.scene(name), keys.runs)
        end, way = words(verdict)
        wrong = [end] * condemned_at_end(verdict) + [way] * condemned_on_the_way(verdict)
        if wrong:
            yield k, f"{name}: the reference itself is not honest there: {'; '.join(wrong)}"


def _nowhere(keys: JacobiansKeys, bench: Bench) -> Iterator[tuple[int, str]]:
    """The functions, by their places, that are asked for in no scene."""
    for k, function in enumerate(keys.functions):
        if not any(has_points(function, scene, bench) for scene in keys.scenes):
            yield k, f"none of the scenes asks for {function}"
