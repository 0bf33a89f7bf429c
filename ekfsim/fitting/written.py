"""What was fitted as files: a world that tells the filter so, and commands that name the log."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from ekfsim.files.given.given import Given
from ekfsim.files.keys.recording import RecordingKeys
from ekfsim.files.scenes.overruling import of_log, overruled
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.source import as_written
from ekfsim.files.yaml.parsing import parse
from ekfsim.fitting.trial import Trial
from ekfsim.version import VERSION

DIGITS = 4  # of a number: its interval is wider by far


def world_text(trial: Trial, settings: Sequence[Setting]) -> str:
    """The scene's world with the numbers under `belief`, all else as it was."""
    given = trial.scene.world.given
    assert isinstance(given, Given)
    on_log = of_log(settings) if is_recorded(trial) else settings
    root, _ = given.tree()
    plain: Any = overruled(root, "world", on_log).plain()
    for one in trial.fit.found:
        place = plain
        *way, last = one.number.route
        for part in way:
            place = place.setdefault(part, {})
        place[last] = float(f"{one.number.in_file(one.value):.{DIGITS}g}")
    return headed(trial, "what the filter is told stands under `belief`", plain)


def commands_text(
    trial: Trial, commands: Path, world: str, out: Path, settings: Sequence[Setting],
    recording: RecordingKeys | None,
) -> str:  # fmt: skip
    """The commands file in that world, its log named from where it will lie."""
    root, _ = parse(as_written(commands, str(commands)), str(commands))
    plain: Any = overruled(root, "commands", settings).plain()
    plain["world"] = world
    plain["filter"] = trial.scene.filter
    if trial.scene.gate is not None:
        plain["gate"] = trial.scene.gate
    else:
        plain.pop("gate", None)
    if recording is not None:
        for way in ("commands", "drive", "expect"):
            plain.pop(way, None)
        said = recording.model_dump(by_alias=True, exclude_unset=True)
        said["path"] = os.path.relpath(str(trial.scene.log_source), out.parent)
        plain["recording"] = said
    return headed(trial, f"`ekfsim run {out.name}` plays it", plain)


def is_recorded(trial: Trial) -> bool:
    """Whether it is a recorded log, not a simulated run."""
    return trial.scene.log is not None and trial.scene.log.given is not None


def headed(trial: Trial, what: str, plain: Any) -> str:
    """A file with a line that tells what made it."""
    source = " ".join(str(trial.scene.log_source).split())
    head = f"# Made by `ekfsim tune` {VERSION} of {source}: {what}.\n"
    return head + yaml.safe_dump(plain, sort_keys=False, allow_unicode=True)
