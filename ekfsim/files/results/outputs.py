"""The files that a run writes besides its narrative, each line as its step comes."""

import json
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from ekfsim.diagnostics.summary import Summary
from ekfsim.errors import UsageError
from ekfsim.files.looking import exists, is_folder
from ekfsim.files.results.trace import Trace
from ekfsim.files.results.trajectories import Table, Tum
from ekfsim.files.results.writing import refuse_existing, special, told, whole_text
from ekfsim.filters.place import stem
from ekfsim.provenance import provenance
from ekfsim.records import Step
from ekfsim.scene import Scene

SUMMARY_FORMAT = 1  # grows when a key of the summary changes its meaning, or goes


class Sink(Protocol):
    """Takes the steps of a run, one at a time."""

    def write(self, step: Step) -> None:
        """Take one step."""


@dataclass(frozen=True)
class Outputs:
    """Which files a run writes, by path; None for those not asked for."""

    trace: Path | None = None
    tum: Path | None = None  # a folder
    csv: Path | None = None
    summary: Path | None = None
    force: bool = False
    filter: str | None = None  # whose files these are, where there are several

    def for_each(self, scene: Scene) -> "list[Outputs]":
        """The files of each filter that watches.
        Of several the name stands before each ending: trace.ekf.jsonl.
        """
        return (
            [self._of(stem(filter)) for filter in (scene.filter, *scene.beside)]
            if scene.beside
            else [self]
        )

    def _of(self, filter: str) -> "Outputs":
        named = [
            None if path is None else _of_filter(path, filter)
            for path in (self.trace, self.csv, self.summary)
        ]
        return replace(self, trace=named[0], csv=named[1], summary=named[2], filter=filter)

    @contextmanager
    def open(self, scene: Scene, confidence: float, summary: Summary) -> Iterator[list[Sink]]:
        """The sinks for the steps of this scene.
        The files appear when the block ends well, all of them or none.

        Raises UsageError before anything is written if one of them exists
        and `force` is False, or is named twice.
        """
        paths = self._paths()
        for path in paths:
            refuse_existing(path, self.force)
            refuse_the_scene_itself(path, scene)
        _refuse_one_place_for_two([path for path in paths if not special(path)])
        unknown = self.unknown_truth(scene)
        paths = [path for path in paths if path != unknown]
        with ExitStack() as stack:
            file_of = {path: stack.enter_context(whole_text(path, self.force)) for path in paths}
            sinks: list[Sink] = []
            tum: Tum | None = None
            if self.trace:
                sinks.append(Trace(file_of[self.trace], scene, confidence))
            if self.csv:
                sinks.append(Table(file_of[self.csv], scene, confidence))
            if self.tum:
                truth, estimate = self._tum()
                tum = Tum(file_of.get(truth), file_of[estimate], scene)
                sinks.append(tum)
            yield sinks
            if tum is not None:
                tum.finish()
            if self.summary:
                json.dump(
                    {"format": SUMMARY_FORMAT, **summary.table(), **provenance(scene)},
                    file_of[self.summary],
                    indent=2,
                    allow_nan=False,
                )
                file_of[self.summary].write("\n")
            for file in file_of.values():
                file.flush()  # a full disk must show before the first of them appears
            if unknown is not None:
                with told(unknown):
                    unknown.unlink(missing_ok=True)  # that of another run

    def unknown_truth(self, scene: Scene) -> Path | None:
        """The file that is left out where a log tells no truth: evo reads none without rows."""
        if scene.log is None or any(entry.truth is not None for entry in scene.log.entries):
            return None
        return next(iter(self._tum()), None)

    def on_stdout(self) -> bool:
        """Whether a result goes to standard output, where the closing summary would spoil it."""
        return any(
            special(path) and os.path.samestat(path.stat(), os.fstat(1)) for path in self._paths()
        )

    def _paths(self) -> list[Path]:
        return [path for path in (self.trace, self.csv, self.summary, *self._tum()) if path]

    def _tum(self) -> tuple[Path, ...]:
        files = (self.tum / "truth.tum", self.tum / "estimate.tum") if self.tum else ()
        return (
            files if self.filter is None else tuple(_of_filter(file, self.filter) for file in files)
        )


def _of_filter(path: Path, filter: str) -> Path:
    """A file's name with the filter before its ending: trace.ekf.jsonl.
    Raises UsageError where it is no file's.
    """
    if special(path):
        raise UsageError(f"{path}: holds the result of one filter only; name a file, or one filter")
    return path.with_name(f"{path.stem}.{filter}{path.suffix}")


def refuse_the_scene_itself(path: Path, scene: Scene) -> None:
    """Raise UsageError where a result would replace the file that it is made from,
    or come to lie within its log.
    """
    sources = (scene.commands_source, scene.world_source, scene.log_source)
    with told(path):
        for source in (Path(name) for name in sources if name is not None):
            if _same(path, source):
                raise UsageError(f"{path}: is what the run is made from; choose another name")
            if is_folder(source) and _same(path.parent, source):
                raise UsageError(f"{path}: lies in the folder of the log; choose another folder")


def _same(path: Path, other: Path) -> bool:
    """Whether two paths lead to one thing. Raises OSError where that may not be looked at."""
    return exists(path) and exists(other) and path.samefile(other)


def _refuse_one_place_for_two(paths: list[Path]) -> None:
    """Raise UsageError where two results,
    however spelled, would come to lie in one place or one inside the other.
    """
    places = list[Path]()
    for path in paths:
        with told(path):
            places.append(Path(os.path.realpath(path.parent)) / path.name)
    for n, (path, place) in enumerate(zip(paths, places, strict=True)):
        if place in places[:n] + places[n + 1 :]:
            raise UsageError(f"{path}: named twice; give each result a file of its own")
        if any(place in other.parents for other in places):
            raise UsageError(
                f"{path}: is to be a file and a folder; give each result a name of its own"
            )
