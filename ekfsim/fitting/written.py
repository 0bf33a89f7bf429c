"""What was fitted as files: a world that tells the filter so, and commands that name the log."""

import os
from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any

import yaml

from ekfsim.files.given.given import Given
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.scenes.overruling import of_log, overruled
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.source import as_written
from ekfsim.files.yaml.parsing import parse
from ekfsim.fitting.trial import Trial
from ekfsim.version import VERSION

WIDTH = 98  # of a line that tells what made a file
DIGITS = 4  # of a number: its interval is wider by far


def world_text(trial: Trial, settings: Sequence[Setting]) -> str:
    """The scene's world with the numbers under `belief`, all else as it was."""
    given = trial.scene.world.given
    assert isinstance(given, Given)
    on_log = of_log(settings) if is_recorded(trial) else settings
    root, _ = given.tree()
    plain: Any = overruled(root, "world", on_log).plain()
    for one in trial.used:
        place = plain
        *way, last = one.number.route
        for part in way:
            place = place.setdefault(part, {})
        place[last] = float(f"{one.number.in_file(one.value):.{DIGITS}g}")
    what = "what the filter is told stands under `belief`"
    return headed(trial, "the numbers are as they were told" if trial.is_worse else what, plain)


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
    """A file with lines that tell what made it, and first whether it is to be trusted."""
    source = " ".join(str(trial.scene.log_source).split())
    lines = [*doubts(trial), f"Made by `ekfsim tune` {VERSION} of {source}: {what}."]
    head = "".join(f"# {line}\n" for told in lines for line in wrap(told, WIDTH))
    return head + yaml.safe_dump(plain, sort_keys=False, allow_unicode=True)


def doubts(trial: Trial) -> list[str]:
    """Why what was fitted is not to be used, or its intervals not to be trusted; mostly nothing."""
    if trial.is_worse:
        return [WORSE, DRIFT if trial.is_coloured else UNLIKE]
    return [COLOURED] if trial.is_coloured else []


WORSE = (
    "NOT TUNED: the half of the log that was held back is clearly less likely with the fitted "
    "numbers than with those that were told. The files keep those that were told."
)
DRIFT = (
    "The innovations are not white: what is left is a bias or a slow drift and no noise. A fit "
    "takes what errs alike for a while for a small noise, and is sure of it for no reason. Look "
    "for a bias, a wrong scale, a delay or a place on the map that is wrong; `robot: {estimate: …}`"
    " has the filter find some of them."
)
UNLIKE = (
    "Its innovations are no bias either: the halves are not alike (a robot that turns in one "
    "only?), and one tells nothing of the other."
)
COLOURED = (
    "NO NOISE ALONE: with the fitted numbers, too, the innovations of the half that was held back "
    "are not white. The numbers do no worse there than those that were told, and their intervals "
    "are too narrow. What is left is a bias or a slow drift: look for a bias, a wrong scale, a "
    "delay or a place on the map that is wrong; `robot: {estimate: …}` has the filter find some of "
    "them."
)
