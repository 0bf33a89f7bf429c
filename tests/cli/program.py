"""The program as its user meets it: in this process where that is enough, else as a process of its
own."""

import io
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

from ekfsim import cli

PROGRAM = "from ekfsim.cli import main; main()"
COMMAND = [sys.executable, "-c", PROGRAM]
MEASURED = """\
import resource, sys
from ekfsim import cli
try: cli.main()
finally: print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)
"""  # tells the most memory that the program ever held, in kB
PATIENCE = 300  # s after which a process that does not end is a failure, on a busy machine, too
ENDINGS = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]

WORLD = """\
name: lab
boundary: [[-5, -5], [5, -5], [5, 5], [-5, 5]]
obstacles:
  - {name: desk, points: [[2, -1], [3, -1], [3, 1], [2, 1]]}
start: {x: 0, y: 0, theta: 0, sigma: {x: 0.1, y: 0.1, theta: 5}}
noise:
  executionDstSigmaRatio: 0.05
  executionAngSigmaRatio: 0.05
  odometryDstSigmaRatio: 0.05
  odometryAngSigmaRatio: 0.05
  rangeSigmaRatio: 0.01
"""
SHORT = """\
world: world.yaml
commands:
  - move: {distance: 1, angle: 90}
  - sense: {angle: 0}
  - say: The end.
"""
LONG = """\
world: world.yaml
commands:
  - repeat: {times: 20000, commands: [{sense: {angle: 0}}, {move: {distance: 0, angle: 10}}]}
"""


@dataclass(frozen=True)
class Ended:
    """How a run of the program ended."""

    status: int
    out: str
    err: str


def lay_out(folder: Path) -> Path:
    """A world and two commands files in a folder."""
    for name, text in {"world.yaml": WORLD, "short.yaml": SHORT, "long.yaml": LONG}.items():
        (folder / name).write_text(text)
    return folder


def ekfsim(*args: object, keys: bytes = b"", encoding: str = "utf-8") -> Ended:
    """Run the program in this process, with these bytes as its standard input."""
    streams = [
        io.TextIOWrapper(io.BytesIO(content), encoding, "replace") for content in (keys, b"", b"")
    ]
    before = {number: signal.getsignal(number) for number in ENDINGS}
    status = 0
    try:
        with (
            patch.object(sys, "argv", ["ekfsim", *map(str, args)]),
            patch.object(sys, "stdin", streams[0]),
            patch.object(sys, "stdout", streams[1]),
            patch.object(sys, "stderr", streams[2]),
        ):
            cli.main()
    except SystemExit as end:
        status = int(end.code or 0)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    for stream in streams[1:]:
        stream.flush()
    return Ended(
        status, *(stream.buffer.getvalue().decode(errors="replace") for stream in streams[1:])
    )


def process(
    *args: object,
    keys: bytes = b"",
    before: str = "",
    after: str = "",
    program: str = PROGRAM,
    **environment: str,
) -> Ended:
    """Run the program as a process, through a shell; before and after it stand what the shell is to
    do about it."""
    environment = {**os.environ, "DISPLAY": "", **environment}
    done = subprocess.run(
        ["bash", "-c", f'{before} "$@" {after}', "bash", sys.executable, "-c", program, *map(str,
        args)],
        input=keys, capture_output=True, timeout=PATIENCE, check=False, env=environment,
    )  # fmt: skip
    return Ended(
        done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
    )


def started(*args: object, **how: object) -> subprocess.Popen[bytes]:
    """The program as a process that goes on."""
    quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    return subprocess.Popen([*COMMAND, *map(str, args)], **{**quiet, **how})  # type: ignore[call-overload]


def wait_for(condition: object, running: subprocess.Popen[bytes]) -> None:
    """Until something holds of a process that has not ended."""
    deadline = time.monotonic() + PATIENCE
    while not condition():  # type: ignore[operator]
        assert running.poll() is None, "it ended before"
        assert time.monotonic() < deadline, "it never came to that"
        time.sleep(0.01)


def ended(running: subprocess.Popen[bytes]) -> Ended:
    """How it ended."""
    try:
        out, err = running.communicate(timeout=PATIENCE)
    finally:
        with suppress(ProcessLookupError):
            running.kill()
    return Ended(running.returncode, (out or b"").decode(), (err or b"").decode())


def left_in(folder: Path) -> list[str]:
    """All that lies in a folder, at any depth."""
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))
