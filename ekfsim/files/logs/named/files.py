"""Which files of a log hold what."""

import os
from pathlib import Path
from typing import NamedTuple, Protocol

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.columns import MotionKeys, ReadingsKeys, TableKeys
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs.folder import find, find_any, missing
from ekfsim.files.logs.named.opening.opened import first_place
from ekfsim.files.logs.named.tables import Source
from ekfsim.files.looking import exists, is_folder, read_from

HOLDS = (
    "motion.csv, readings.csv and, where they are known, landmarks.csv, truth.csv and world.yaml"
)
MOTION = ("motion*.csv", "odometry*.csv")
NAMED = "one by another name is told by recording: {{{}}}"
READINGS = "readings"  # how the names of its tables begin
LANDMARKS = ("landmarks*.csv",)
TRUTH = ("truth*.csv", "truth*.tum")


class Sources(Protocol):
    """Where a log's tables are, in files or elsewhere."""

    @property
    def no_truth(self) -> str:
        """Why there is no truth, where there is none."""

    def motion(self) -> tuple[Source, MotionKeys]:
        """What the robot did."""

    def readings(self) -> list[tuple[Source, ReadingsKeys]]:
        """What the sensors told."""

    def landmarks(self) -> Source | None:
        """What stands where, None where the log does not tell."""

    def truth(self) -> Source | None:
        """The true poses, None where the log has none."""

    def on_one_plane(self, warnings: list[str]) -> "Sources":
        """The same, with one origin for all that is told by latitude and longitude, which is told.
        Raises as `opened` does.
        """


class Files(NamedTuple):
    """Where a log's tables are, and what is said of each."""

    folder: Path
    alone: Path | None  # the file that is the whole log
    recording: RecordingKeys

    @property
    def no_truth(self) -> str:
        """Which files are not there."""
        return "no truth.csv and no truth.tum in it"

    def motion(self) -> tuple[Source, MotionKeys]:
        """What the robot did. Raises UsageError where no file holds it, or several may."""
        keys = self.recording.motion or MotionKeys()
        file = (
            self._told(keys)
            or self.alone
            or find(
                self.folder, "what the robot did", *MOTION, cure=NAMED.format("motion: {file: …}")
            )
        )
        return Source(file, keys, self.recording), keys

    def readings(self) -> list[tuple[Source, ReadingsKeys]]:
        """What the sensors told, in the order in which it is named, else of the files' names.
        Raises UsageError where no file holds it.
        """
        found = []
        for keys in self.recording.readings or [ReadingsKeys()]:
            told = self._told(keys) or self.alone
            for file in self._all_readings() if told is None else [told]:
                found.append((Source(file, keys, self.recording), keys))
        return found

    def landmarks(self) -> Source | None:
        """What stands where, None where the log does not tell."""
        keys = self.recording.landmarks
        file = self._own(keys, "the landmarks", LANDMARKS)
        return None if file is None else Source(file, keys or TableKeys(), self.recording)

    def truth(self) -> Source | None:
        """The true poses, None where the log has none."""
        keys = self.recording.truth
        file = self._own(keys, "the true poses", TRUTH)
        return None if file is None else Source(file, keys or TableKeys(), self.recording)

    def on_one_plane(self, warnings: list[str]) -> "Files":
        """The same, with one origin for all places on the earth: the first fix, else the first true
        place, where the commands file names none. Raises as `opened` does.
        """
        if self.recording.origin is not None:
            return self
        truth = self.truth()
        for source in [one for one, _ in self.readings()] + [truth] * (truth is not None):
            origin = first_place(source) if source is not None else None
            if source is not None and origin is not None:
                warnings.append(
                    f"{source.path}: x is m east and y m to true north of its first place, latitude"
                    f" {origin.latitude:.9g}°, longitude {origin.longitude:.9g}°; say otherwise "
                    "with recording: {origin: {latitude: …, longitude: …}}"
                )
                return self._replace(recording=self.recording.model_copy(update={"origin": origin}))
        return self

    def _told(self, keys: TableKeys) -> Path | None:
        """The file that is named."""
        return None if keys.file is None else self.folder / keys.file

    def _own(self, keys: TableKeys | None, what: str, usual: tuple[str, ...]) -> Path | None:
        """The file of a table that a log may lack."""
        if keys is not None:
            return self._told(keys) or self.alone or find(self.folder, what, *usual)
        return None if self.alone else find_any(self.folder, what, *usual)

    def _all_readings(self) -> list[Path]:
        with read_from(self.folder):
            names = sorted(name for name in os.listdir(self.folder) if name.endswith(".csv"))
        found = [self.folder / name for name in names if name.startswith(READINGS)]
        if not found:
            cure = NAMED.format("readings: [{file: …}]")
            raise missing(self.folder, "the readings", f"{READINGS}*.csv", cure=cure)
        return found


def files_of(path: Path, recording: RecordingKeys) -> Files:
    """The files of a log, a folder or one file. Raises UsageError where there is no such thing."""
    with read_from(path):
        if not exists(path):
            right = f"name a folder that holds {HOLDS}, or one file"
            raise UsageError(f"{path}: no such file or folder; {right}")
        return (
            Files(path, None, recording) if is_folder(path) else Files(path.parent, path, recording)
        )
