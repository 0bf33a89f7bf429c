"""CPU time of `ekfsim --help` against `python -c "import irsim"`, whole processes in turn.

python benchmarks/start.py [--quick]
"""

import argparse
import os
import subprocess
import sys
from importlib.util import find_spec
from statistics import median


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    rounds = 3 if parser.parse_args().quick else 11
    ours = [sys.executable, "-c", "from ekfsim.cli import main; main()", "--help"]
    peers = {"python -c pass": [sys.executable, "-c", "pass"]}
    if find_spec("irsim") is not None:
        peers["python -c 'import irsim'"] = [sys.executable, "-c", "import irsim"]
    else:
        print("skipped: irsim is not installed")
    times = [[cpu(command) for command in (ours, *peers.values())] for _ in range(rounds + 1)][1:]
    mine = median(row[0] for row in times)
    for i, name in enumerate(peers, start=1):
        ratio, theirs = median(row[i] / row[0] for row in times), median(row[i] for row in times)
        print(f"{ratio:9.1f} × {name:32s} {theirs * 1e3:8.1f} ms, ours {mine * 1e3:8.1f} ms")


def cpu(command: list[str]) -> float:
    """Processor seconds of a process from its start to its end."""
    before = os.times()
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    after = os.times()
    return (
        after.children_user + after.children_system - before.children_user - before.children_system
    )


if __name__ == "__main__":
    main()
