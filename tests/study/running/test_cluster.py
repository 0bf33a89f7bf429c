"""Studies on a real Dask scheduler with two workers, on loopback; whatever dies, they end alike."""

import json
import os
import socket
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from ekfsim.errors import StepError
from ekfsim.files.scenes.load_study import read_request
from ekfsim.files.scenes.settings import filters_in
from ekfsim.files.template import template
from ekfsim.study.plan import Plan
from ekfsim.study.running.cluster import cluster
from ekfsim.study.running.doing import unkept
from ekfsim.study.running.engines import serial as serially

pytest.importorskip("distributed", reason="the cluster's tests need the extra 'cluster'")

PATIENCE = 60  # s
PROGRAM = [sys.executable, "-c", "from ekfsim.cli import main; main()"]
BLOCKS = 12
TABLES = ("summary.csv", "steps.csv", "nees.png", "coverage.png", "divergence.png", "study.yaml")
WORLD = Path(__file__).resolve().parents[3] / "worlds" / "furnished-room.yaml"
COMMANDS = f"""\
world: {WORLD}
commands:
  - repeat: {{times: 15, commands: [{{sense: {{angle: 40}}}}, {{move: {{distance: 0.5, angle: \
100}}}}]}}
"""

FAULTY = """
class StrangeError(Exception):
    def __init__(self, one, two):
        super().__init__(one)

def predict(x, P, u, motion):
    raise StrangeError("as if", 2)
    return x, P
"""


@contextmanager
def running(*command, **how):
    """A process that is gone when the block ends."""
    quiet = {
        "stdin": subprocess.DEVNULL,
        "stdout": subprocess.DEVNULL,
        "stderr": subprocess.DEVNULL,
    }
    process = subprocess.Popen([*map(str, command)], **{**quiet, **how})
    try:
        yield process
    finally:
        if process.poll() is None:
            process.terminate()
        try:
            process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stderr is not None:
            process.stderr.close()


def until(condition, what):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, what
        time.sleep(0.02)


class Cluster:
    """A scheduler and two workers."""

    def __init__(self, folder):
        self.folder, self.file = folder, folder / "scheduler.json"
        self.stack, self.workers = ExitStack(), []

    def __enter__(self):
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        where = ("--host", "127.0.0.1", "--no-dashboard")
        dask = (sys.executable, "-m", "distributed.cli.dask_scheduler")
        options = (*where, "--port", 0, "--scheduler-file", self.file)
        self.scheduler = self.stack.enter_context(running(*dask, *options, env=environment))
        until(lambda: self.file.exists() and self.file.read_text().endswith("}"), "no scheduler")
        self.address = json.loads(self.file.read_text())["address"]
        dask = (sys.executable, "-m", "distributed.cli.dask_worker", self.address)
        options = (
            *where,
            "--no-nanny",
            "--nthreads",
            1,
            "--death-timeout",
            30,
            "--local-directory",
            self.folder,
        )
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        # the last that began is the first to end: workers before their scheduler
        for _ in range(2):
            worker = running(*dask, *options, env=environment, cwd=elsewhere)
            self.workers.append(self.stack.enter_context(worker))
        return self

    def __exit__(self, *exception):
        self.stack.close()

    def ready(self):
        """Wait until both workers have come."""
        import distributed

        with distributed.Client(self.address, set_as_default=False, timeout=PATIENCE) as client:
            client.wait_for_workers(2, timeout=PATIENCE)
        return self


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "commands.yaml").write_text(COMMANDS)
    return tmp_path


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """The same study in one process, that nothing ended early."""
    folder = tmp_path_factory.mktemp("serial")
    (folder / "commands.yaml").write_text(COMMANDS)
    in_this_process("out", cwd=folder)
    return folder / "out"


def study(out, *more):
    options = ("--runs", BLOCKS * 1024 - 100, "--filter", "ekf,ukf", "-o", out)
    return [*PROGRAM, "study", "commands.yaml", *map(str, options), *map(str, more)]


def done(out):
    """How many blocks are on disk."""
    journal = Path(f"{out}.partial/journal.jsonl")
    return journal.read_bytes().count(b"\n") - 1 if journal.exists() else 0


def ended(process):
    _, err = process.communicate(timeout=PATIENCE)
    return process.returncode, err.decode().splitlines()


def check_alike(one, other):
    for name in TABLES:
        assert (Path(one) / name).read_bytes() == (Path(other) / name).read_bytes(), name


def in_this_process(out, *more, cwd=None):
    command = study(out, *more)
    subprocess.run(command, check=True, timeout=2 * PATIENCE, stdout=subprocess.DEVNULL, cwd=cwd)


def test_a_worker_that_dies_changes_nothing(place, serial):
    with Cluster(place) as cluster:
        cluster.ready()
        with running(
            *study("clustered", "--cluster", cluster.address), stderr=subprocess.PIPE
        ) as process:
            until(lambda: done("clustered") >= 2, "nothing was done")
            assert process.poll() is None
            cluster.workers[1].kill()
            assert ended(process) == (0, [])
    check_alike(serial, "clustered")


def test_a_scheduler_that_dies_leaves_what_was_done(place, serial):
    with Cluster(place) as cluster:
        cluster.ready()
        with running(
            *study("out", "--cluster", cluster.address), stderr=subprocess.PIPE
        ) as process:
            until(lambda: done("out") >= 2, "nothing was done")
            cluster.scheduler.kill()
            status, lines = ended(process)
    assert status == 1
    (line,) = lines
    assert line.startswith(f"ekfsim: the scheduler at {cluster.address} is gone; ")
    assert line.endswith(
        f" of {2 * BLOCKS} blocks are kept in out.partial, --resume goes on with the rest"
    )
    assert done("out") >= 2
    in_this_process("out", "--resume")
    check_alike(serial, "out")


def test_workers_in_another_folder_find_a_filter_of_ones_own(place):
    """The class of its exception is known to none but the worker, and is not sent."""
    (place / "parts.py").write_text("from numpy import eye\n")
    whole = template("filter-complete").replace("np.eye", "eye")
    whole = whole.replace("import numpy as np", "import numpy as np\nfrom parts import eye")
    (place / "mine.py").write_text(whole)
    (place / "faulty.py").write_text(f"{whole}\n{FAULTY}")

    (place / "short.yaml").write_text(COMMANDS.replace("times: 15", "times: 2"))

    def made(filters, engine):
        request = read_request("short.yaml")
        plan = Plan.of(replace(request, runs=40, filters=filters_in(filters)))
        return [json.dumps(one.tally.plain()) for one in unkept(plan, engine, lambda *block: None)]

    with Cluster(place) as there:
        clustered = cluster(there.ready().address, lambda told: None)
        assert made("mine.py,ekf", clustered) == made("mine.py,ekf", serially)
        with pytest.raises(StepError) as fault:
            made("faulty.py", clustered)
    number = (place / "faulty.py").read_text().count("\n") - 1
    assert str(fault.value) == (
        f"{place}/faulty.py:{number}: run 0, step 2 (move 0.5 m, 100°): StrangeError: as if"
    )


def test_a_scheduler_that_is_not_there_is_told_in_a_line(place):
    with running(
        *study("out", "--cluster", "tcp://127.0.0.1:9"), stderr=subprocess.PIPE
    ) as process:
        assert ended(process) == (
            1,
            [
                "ekfsim: no scheduler at tcp://127.0.0.1:9: Connection refused; start one with "
                "`dask scheduler`"
            ],
        )
    with running(*study("out", "--cluster", "nowhere"), stderr=subprocess.PIPE) as process:
        assert ended(process) == (
            2,
            [
                "ekfsim: --cluster nowhere: is no address of a scheduler; write e.g. "
                "tcp://127.0.0.1:8786"
            ],
        )
    assert not (place / "out.partial").exists()


def test_what_answers_and_is_no_scheduler_is_told_in_a_line(place):
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with running(*study("out", "--cluster", address), stderr=subprocess.PIPE) as process:
            wire, _ = server.accept()
            wire.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
            assert ended(process) == (
                1,
                [f"ekfsim: no scheduler at {address}: something else answers there"],
            )
            wire.close()
    assert not (place / "out.partial").exists()


def test_a_worker_of_another_version_is_told_in_a_line(place):
    told = "from ekfsim.study.running.engines import do_packed; do_packed(b'', 0, 1, '0.0.1')"
    failed = subprocess.run(
        [sys.executable, "-c", told], capture_output=True, text=True, check=False
    )
    assert "install the same version there" in failed.stderr
