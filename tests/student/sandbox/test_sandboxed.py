import json
import os
import signal
import subprocess
import sys
import time
from collections import deque
from itertools import islice, repeat
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from student.sandbox.broken import (
    BROKEN,
    EVERY,
    FORGED,
    HARMLESS,
    MARKED,
    RIGHT,
    SECONDS,
    TOO_BUSY,
    TOO_LONG,
    WALL,
    doing,
)

import ekfsim
from ekfsim.commands import Say
from ekfsim.errors import RunError, UsageError
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.echo import Echo
from ekfsim.models.sensors.position import Position
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Asked
from ekfsim.student.fault import FaultError
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.loading import load
from ekfsim.student.sandbox import process, sandboxed
from ekfsim.student.sandbox.kernel import lacking, landlock
from ekfsim.student.sandbox.limits import Limits
from ekfsim.student.sandbox.sandboxed import Sandboxed

BUSY = Limits(cpu_seconds=SECONDS, wall_seconds=60)
WAITED = Limits(cpu_seconds=20, wall_seconds=WALL)
AMPLE = Limits(cpu_seconds=20, wall_seconds=100)
ASKED = Asked(
    np.array([1.0, 2.0, 0.3]),
    np.eye(3) * 0.1,
    Control(MoveTurn(0.1, 0.1), np.array([1.0, 0.5])),
)
KNOWN = 3.0 ** np.arange(3)


@pytest.fixture
def mine(tmp_path):
    def written(text):
        file = tmp_path / "mine.py"
        file.write_text(text, encoding="utf-8")
        return file

    return written


def asked_once(caller):
    """A run of one step."""
    caller.begin(ASKED.x, ASKED.P)
    return caller.call(ASKED)


@pytest.mark.parametrize("name", ["tour", "mower", "pioneer", "gnss", "pylon"])
def test_what_comes_back_is_what_the_same_code_answers_here(name, mine):
    file = mine(RIGHT)
    here = InProcess(load(str(file)))
    told = (
        step
        for step in ekfsim.play(ekfsim.load_scene(name))
        if step.prediction or (step.correction and not step.correction.refused)
    )
    steps = list(islice(told, 60))
    with Sandboxed(file, limits=AMPLE) as there:
        for caller in (here, there):
            assert caller.begin(*steps[0].prior) is None
        for step in steps:
            asked = Asked(*step.prior, step.entry.given, step.layout.headings)
            ours, theirs = here.call(asked), there.call(asked)
            assert np.array_equal(ours.x, theirs.x)
            assert np.array_equal(ours.P, theirs.P)


@pytest.mark.parametrize(("text", "told"), BROKEN.values(), ids=BROKEN)
def test_a_broken_file_is_told_in_a_line_and_costs_no_more_than_its_limit(text, told, mine):
    limits = BUSY if TOO_BUSY in told.pattern else WAITED if TOO_LONG in told.pattern else AMPLE
    with Sandboxed(mine(text), limits=limits) as caller:
        for _ in range(2):  # nor is it better when it is asked again
            with pytest.raises(FaultError, match=told) as raised:
                asked_once(caller)
            assert "\n" not in str(raised.value)
            assert len(str(raised.value)) < 600


@pytest.mark.parametrize("text", HARMLESS.values(), ids=HARMLESS)
def test_what_disturbs_nobody_costs_nothing(text, mine):
    file = mine(text)
    right = InProcess(load(str(mine(RIGHT)))).call(ASKED)
    mine(text)
    with Sandboxed(file, limits=AMPLE) as caller:
        theirs = asked_once(caller)
        assert np.array_equal(theirs.x, right.x)
        assert np.array_equal(theirs.P, right.P)
    assert file.read_text(encoding="utf-8") == text  # his own is never touched


def test_who_answers_for_itself_is_judged_by_it_and_not_asked_again(mine):
    text = doing(MARKED + EVERY.format("head + struct.pack('<12d', *numbers)"))
    with Sandboxed(mine(text), limits=AMPLE) as caller:
        assert asked_once(caller).x.tolist() == [0, 1, 2]
        with pytest.raises(FaultError, match=FORGED):
            caller.call(ASKED)


def test_who_does_not_listen_is_not_waited_for(mine):
    stop = "threading.Timer(1, os.kill, [os.getpid(), signal.SIGSTOP]).start()"
    long = Reading(Echo(np.zeros(10**5), 1.0), np.zeros(1))
    with Sandboxed(mine(doing(stop)), limits=Limits(wall_seconds=3)) as caller:
        asked_once(caller)
        time.sleep(1.2)
        with pytest.raises(FaultError, match=r"\Amine\.py: was waited for longer than 3 s\Z"):
            caller.call(Asked(ASKED.x, ASKED.P, long))


def test_what_it_prints_is_shortened_and_inert(mine):
    with Sandboxed(mine(HARMLESS["prints in colour"]), limits=AMPLE) as caller:
        asked_once(caller)
        assert caller.printed == "\\x1b[31mred\\x07\n"
    with Sandboxed(mine(HARMLESS["prints much"]), limits=AMPLE) as caller:
        asked_once(caller)
        shown = caller.printed
    kept = "\\x00" * AMPLE.printed
    assert shown.startswith(f"{kept}… and 6")
    assert len(shown) < len(kept) + 40


def test_a_fault_of_one_step_leaves_the_next_one_alone(mine):
    with Sandboxed(mine(doing("if u[0] < 0: 1 / 0")), limits=AMPLE) as caller:
        right = asked_once(caller)
        back = Asked(ASKED.x, ASKED.P, Control(ASKED.given.motion, np.array([-1.0, 0.0])))
        with pytest.raises(FaultError, match=r"\Amine\.py:6: ZeroDivisionError: division by zero"):
            caller.call(back)
        assert np.array_equal(caller.call(ASKED).x, right.x)


CLASS = """\
class Mine:
    def __init__(self, x, P):
        self.x, self.P, self.steps = x, P, 0

    def predict(self, u, motion):
        self.steps += 1
        self.x = self.x + self.steps

    def update(self, z, sensor):
        pass
"""


def test_runs_side_by_side_have_objects_of_their_own_and_a_new_run_a_new_one(mine):
    with Sandboxed(mine(CLASS), limits=AMPLE) as caller:
        other = caller.new_caller()
        for one in (caller, other):
            one.begin(np.zeros(3), ASKED.P)
        still = Asked(np.zeros(3), ASKED.P, ASKED.given)
        assert [one.call(still).x[0] for one in (caller, caller, other)] == [1, 2, 1]
        caller.begin(np.zeros(3), ASKED.P)
        assert [one.call(still).x[0] for one in (caller, other)] == [1, 2]


def test_runs_side_by_side_are_asked_together(mine, monkeypatch):
    """They answer as one by one, up to the one that fails, and go on as one by one after it."""
    monkeypatch.setattr(sandboxed, "AT_ONCE", 4)
    text = doing("if u[0] < 0: 1 / 0")
    motions = [MoveTurn(0.1, 0.1 * k) for k in range(10)]  # a model that is new in every call
    inputs = [np.array([1.0 + k, 0.5]) for k in range(10)]
    here = InProcess(load(str(mine(text))))
    right = [
        here.call(Asked(ASKED.x, ASKED.P, Control(*one)))
        for one in zip(motions, inputs, strict=True)
    ]
    inputs[6] = -inputs[6]
    with Sandboxed(mine(text), limits=AMPLE) as caller:
        calls = [
            (caller.new_caller(), Asked(ASKED.x, ASKED.P, Control(*one)))
            for one in zip(motions, inputs, strict=True)
        ]
        answers = caller.together(calls)
        for expected, theirs in zip(right[:6], answers, strict=False):
            assert np.array_equal(theirs.x, expected.x)
            assert np.array_equal(theirs.P, expected.P)
        with pytest.raises(FaultError, match=r"\Amine\.py:6: ZeroDivisionError"):
            next(answers)
        for expected, theirs in zip(right[7:], caller.together(calls[7:]), strict=True):
            assert np.array_equal(theirs.P, expected.P)
        assert np.array_equal(calls[7][0].call(calls[7][1]).P, right[7].P)


def test_who_ends_among_others_has_answered_before(mine):
    with Sandboxed(mine(doing("if u[0] < 0: os._exit(0)")), limits=AMPLE) as caller:
        inputs = [np.array([length, 0.5]) for length in (1.0, 2.0, -3.0, 4.0)]
        motion = ASKED.given.motion
        answers = caller.together(
            [(caller.new_caller(), Asked(ASKED.x, ASKED.P, Control(motion, u))) for u in inputs]
        )
        assert [round(float(np.hypot(*(next(answers).x - ASKED.x)[:2]))) for _ in "12"] == [1, 2]
        for again in (answers, caller.together([(caller.new_caller(), ASKED)])):
            with pytest.raises(FaultError, match="ended its process with status 0"):
                next(again)


def test_the_place_of_what_is_called_is_told(mine):
    with Sandboxed(mine(RIGHT), limits=AMPLE) as caller:
        caller.begin(ASKED.x, ASKED.P)
        assert caller.place_of(ASKED.given) == "mine.py:6"


def test_his_own_derivatives_are_called(mine):
    own = "def F(x, u, motion):\n    return [[1, 0, -u[0]], [0, 1, x[0]], [0, 0, 1]]\n"
    own += "def G(x, u, motion):\n    return 2 * motion.F(x, u)\n"
    own += "def H(x, sensor):\n    return [[sensor.sigma_x, 0, 1], [0, 1, 0]]\n"
    fix = Reading(Position(0.5, 0.25), np.zeros(2))
    with Sandboxed(mine(RIGHT + own), provided=("f",), limits=AMPLE) as caller:
        assert caller.derivative("H", ASKED.x, fix).tolist() == [[0.5, 0, 1], [0, 1, 0]]
        assert caller.derivative("F", ASKED.x, ASKED.given).tolist() == [
            [1, 0, -1],
            [0, 1, 1],
            [0, 0, 1],
        ]
        with pytest.raises(FaultError, match=r"mine\.py:17: motion\.F is not provided; write thi"):
            caller.derivative("G", ASKED.x, ASKED.given)
    with Sandboxed(mine(RIGHT + own.replace("def H", "def h")), limits=AMPLE) as caller:
        with pytest.raises(
            FaultError, match=r"mine\.py:17: G has the shape \(3, 3\), not \(3, 2\)"
        ):
            caller.derivative("G", ASKED.x, ASKED.given)
        with pytest.raises(FaultError, match=r"mine\.py: there is no function H\(x, sensor\)"):
            caller.derivative("H", ASKED.x, fix)


def test_what_it_is_given_to_live_with(mine):
    """No environment, no descriptors but the exchange's two, its own folder, and limits."""
    told = """\
import resource
kinds = "AS", "FSIZE", "CPU", "NOFILE", "CORE"
print([resource.getrlimit(getattr(resource, f"RLIMIT_{kind}"))[0] for kind in kinds])
print(sorted(os.environ), sys.argv == [__file__], os.listdir("."), sys.flags.isolated)
held = []
for one in range(200):
    try:
        held.append(os.fstat(one)[0] and one)
    except OSError:
        pass
print(len(held))
try:
    os.chown(__file__, 12345, 12345)
except PermissionError:
    print("no privileges")"""
    spare = os.open(os.devnull, os.O_RDONLY)
    os.set_inheritable(spare, True)
    limits = Limits(cpu_seconds=7, memory_mb=700, file_mb=3)
    try:
        with Sandboxed(mine(doing(told)), limits=limits) as caller:
            asked_once(caller)
            first, second, third, fourth = caller.printed.splitlines()
    finally:
        os.close(spare)
    memory, file, cpu, *others = json.loads(first)
    assert [memory, file, others] == [700 * 2**20, 3 * 2**20, [128, 0]]
    assert cpu > 7  # what it took to start is not charged
    own = ["HOME", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "TMPDIR"]
    assert second == f"{own} True ['mine.py'] 1"
    assert fourth == "no privileges"  # not even root has them
    assert third == "5"  # nothing to read, what it prints to twice, the exchange's two


def test_it_is_sent_neither_commands_nor_what_was_before_nor_steps(mine, monkeypatch):
    sent = []

    def packed(message):
        sent.append(message.content)
        return whole(message)

    whole = process.packed
    monkeypatch.setattr(process, "packed", packed)
    before = Asked(KNOWN, np.diag(KNOWN), ASKED.given)
    asked = Asked(ASKED.x, ASKED.P, ASKED.given, (2,), Say("truth"), 4711, before)
    with Sandboxed(mine(RIGHT), limits=AMPLE) as caller:
        asked_once(caller)
        caller.call(asked)
    assert len(sent) == 4
    assert b"MoveTurn" in sent[2]
    assert not any(word in text for word in (b"truth", b"4711", b"9.0") for text in sent)
    assert len(sent[3]) < 200  # what the motion is, is known by now


def is_running(number):
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    return True


STAYS = """\
told, tells = os.pipe()
if os.fork() == 0:
    os.setsid()
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    if os.fork() == 0:
        os.write(1, f"{os.getpid()}\\n".encode())
        os.write(tells, b".")
        time.sleep(60)
    os._exit(0)
os.wait()
os.read(told, 1)"""


@pytest.mark.skipif(sys.platform != "linux", reason="nobody takes in orphans elsewhere")
def test_what_it_started_ends_with_it_wherever_it_has_gone(mine):
    with Sandboxed(mine(doing(STAYS)), limits=AMPLE) as caller:
        asked_once(caller)
        left = int(caller.printed)
        assert is_running(left)
    assert not is_running(left)
    assert caller.left == 1


@pytest.mark.skipif(sys.platform != "linux", reason="nobody takes in orphans elsewhere")
def test_what_is_left_is_told_also_where_the_code_ends_before_who_watches_it(mine, monkeypatch):
    def later(process, number):
        if number == signal.SIGCONT:  # it is stopped, as on a busy machine; the code ends meanwhile
            time.sleep(0.3)
            os.kill(process.pid, number)

    monkeypatch.setattr(subprocess.Popen, "send_signal", later)
    caller = Sandboxed(mine(doing(STAYS)), limits=AMPLE)
    asked_once(caller)
    os.kill(caller._process._process.pid, signal.SIGSTOP)
    caller.close()
    assert caller.left == 1


@pytest.mark.skipif(sys.platform != "linux", reason="nobody takes in orphans elsewhere")
def test_all_ends_when_the_parent_is_killed(mine, tmp_path):
    program = f"""
import sys, time
from pathlib import Path
from student.sandbox.test_sandboxed import AMPLE, ASKED, Sandboxed, asked_once
caller = Sandboxed(Path({str(mine(doing(STAYS)))!r}), limits=AMPLE)
asked_once(caller)
caller.place_of(ASKED.given)
print(caller.printed, flush=True)
time.sleep(60)
"""
    paths = (str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", ""))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "TMPDIR": str(tmp_path)}
    command = [sys.executable, "-c", program]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as parent:
        left = int(parent.stdout.readline())
        assert is_running(left)
        assert any(tmp_path.glob("ekfsim-*"))
        parent.send_signal(signal.SIGKILL)
    until = time.monotonic() + 10
    while (is_running(left) or any(tmp_path.glob("ekfsim-*"))) and time.monotonic() < until:
        time.sleep(0.02)
    assert not is_running(left)
    assert not any(tmp_path.glob("ekfsim-*"))  # nor is its folder left


def test_who_is_not_calculating_is_charged_nothing(mine):
    text = doing(f"time.sleep({2 * SECONDS})")
    with Sandboxed(mine(text), limits=BUSY) as caller:
        assert np.array_equal(asked_once(caller).x, InProcess(load(str(mine(RIGHT)))).call(ASKED).x)


BETWEEN = {
    "steps together": "began = time.process_time()\nwhile time.process_time() < began + 0.1: pass",
    "a thread between steps": """\
def busy():
    while True: pass
if threading.active_count() == 1: threading.Thread(target=busy, daemon=True).start()""",
}


@pytest.mark.parametrize("text", BETWEEN.values(), ids=BETWEEN)
def test_what_it_calculates_is_added_up(text, mine):
    with Sandboxed(mine(doing(text)), limits=BUSY) as caller:
        caller.begin(ASKED.x, ASKED.P)
        with pytest.raises(FaultError, match=rf"\Amine\.py(:\d+)?: {TOO_BUSY}\Z"):
            deque(map(caller.call, repeat(ASKED)), maxlen=0)


def test_many_processes_are_told(mine):
    text = doing("for _ in range(60):\n    if os.fork() == 0: time.sleep(9)\ntime.sleep(9)")
    with (
        Sandboxed(mine(text), limits=Limits(wall_seconds=20, processes=8)) as caller,
        pytest.raises(FaultError, match=r"started more than 8 processes|BlockingIOError"),
    ):
        asked_once(caller)


def test_it_can_be_begun_through_a_command(mine):
    file = mine(doing("print(sorted(os.environ)[0], os.environ.get('SECRET'))"))
    with Sandboxed(file, limits=AMPLE, through=("env", "SECRET=1")) as caller:
        assert np.array_equal(asked_once(caller).P, InProcess(load(str(file))).call(ASKED).P)
        assert caller.printed == "HOME None\n"
    with Sandboxed(file, limits=AMPLE, through=("env", "SECRET=1", sys.executable)) as caller:
        asked_once(caller)
        assert caller.printed == "HOME None\n"


def test_a_command_that_begins_nothing_is_not_held_against_the_student(mine, monkeypatch):
    with (
        Sandboxed(mine(RIGHT), through=("no-such-command",)) as caller,
        pytest.raises(UsageError, match=r"\Ano-such-command: cannot be started: "),
    ):
        asked_once(caller)
    with (
        Sandboxed(mine(RIGHT), through=("sh", "-c", "echo sorry >&2; exit 3", "sh")) as caller,
        pytest.raises(RunError, match=r"ended its process with status 3 .*; it says: sorry\Z"),
    ):
        asked_once(caller)
    monkeypatch.setattr(process, "STARTING", 0.1)
    with (
        Sandboxed(mine(RIGHT), through=("sh", "-c", "sleep 9", "sh")) as caller,
        pytest.raises(RunError, match=r"did not start within 0\.1 s\Z"),
    ):
        asked_once(caller)


def test_where_nothing_can_be_limited_nothing_is_graded(mine, monkeypatch):
    monkeypatch.setattr(sandboxed, "os", SimpleNamespace(name="nt"))
    with pytest.raises(UsageError, match="grade on Linux or macOS, on Windows in WSL"):
        Sandboxed(mine(RIGHT))


OUTSIDE = """\
def tried(what, *args, **kwargs):
    try:
        what(*args, **kwargs)
        print("done")
    except OSError as error:
        print(type(error).__name__)

import socket
tried(open, {file!r})
tried(open, {file!r}, "w")
tried(os.listdir, "/")
tried(open, f"/proc/{{os.getppid()}}/environ")
tried(open, "own", "w")
tried(socket.create_connection, ("127.0.0.1", 9), 1)
tried(os.kill, os.getppid(), 0)"""


def test_where_the_kernel_can_it_is_fenced_in(mine, tmp_path):
    other = tmp_path / "other.py"
    other.write_text("theirs")
    with Sandboxed(mine(doing(OUTSIDE.format(file=str(other)))), limits=AMPLE) as caller:
        asked_once(caller)
        *files, own, tcp, signals = caller.printed.splitlines()
        lacks = " ".join(caller.lacks)
        assert caller.lacks == lacking(landlock())  # what the kernel can is done
    if "read and write" not in lacks:
        assert files == ["PermissionError"] * 4
        assert other.read_text() == "theirs"
    assert own == "done"
    assert tcp == ("ConnectionRefusedError" if "connections" in lacks else "PermissionError")
    assert signals == ("done" if "signals" in lacks else "PermissionError")


def test_what_a_machine_lacks_is_told():
    assert lacking(6, linux=True) == ()
    assert len(lacking(4, linux=True)) == 1
    assert len(lacking(1, linux=True)) == 2
    assert len(lacking(0, linux=True)) == 3
    assert lacking(0, linux=True) == lacking(0, linux=False)[1:]
