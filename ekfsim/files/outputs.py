"""The files that a run writes besides its narrative, each line as its step comes."""

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from ekfsim.errors import UsageError
from ekfsim.files.trace import Trace
from ekfsim.files.trajectories import Table, Tum
from ekfsim.files.writing import refuse_existing, special, whole_text
from ekfsim.provenance import provenance
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.summary import Summary


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

    @contextmanager
    def open(self, scene: Scene, confidence: float, summary: Summary) -> Iterator[list[Sink]]:
        """The sinks for the steps of this scene. The files appear when the block ends well, all of them or none.

        Raises UsageError before anything is written if one of them exists and `force` is False, or is named twice.
        """
        paths = [path for path in (self.trace, self.csv, self.summary, *self._tum()) if path]
        for path in paths:
            refuse_existing(path, self.force)
            if paths.count(path) > 1 and not special(path):
                raise UsageError(f"{path}: named twice; give each result a file of its own")
        with ExitStack() as stack:
            file_of = {path: stack.enter_context(whole_text(path, self.force)) for path in paths}
            sinks: list[Sink] = []
            if self.trace:
                sinks.append(Trace(file_of[self.trace], scene, confidence))
            if self.csv:
                sinks.append(Table(file_of[self.csv], scene, confidence))
            if self.tum:
                truth, estimate = self._tum()
                sinks.append(Tum(file_of[truth], file_of[estimate], scene))
            yield sinks
            if self.summary:
                json.dump({**summary.table(), **provenance(scene)}, file_of[self.summary], indent=2, allow_nan=False)
                file_of[self.summary].write("\n")

    def _tum(self) -> tuple[Path, ...]:
        return (self.tum / "truth.tum", self.tum / "estimate.tum") if self.tum else ()
