"""Files that a student could hand in, each broken in its own way, and the line that tells of it."""

import re

RIGHT = """\
import numpy as np


def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T + motion.Q(u)


def update(x, P, z, sensor):
    H = sensor.H(x)
    S = H @ P @ H.T + sensor.R(x)
    K = P @ H.T @ np.linalg.inv(S)
    return x + K @ sensor.residual(z, sensor.h(x)), (np.eye(len(x)) - K @ H) @ P
"""
HEAD = "def predict(x, P, u, motion):\n"
EVERY = """\
for descriptor in range(3, 30):
    try:
        os.write(descriptor, {})
    except OSError:
        pass"""
SECONDS = 0.5  # of CPU, of the limit that endless ones are given
WALL = 1.5  # s that sleepers are waited for
TOO_BUSY = f"took longer than {SECONDS:g} s of CPU"
TOO_LONG = f"was waited for longer than {WALL:g} s"
MARKED = """\
import struct
frame = sys._getframe()
while "mark" not in frame.f_locals:
    frame = frame.f_back
head = struct.pack("<IB3x8s", 96, 1, frame.f_locals["mark"])
numbers = list(np.arange(12.0))
"""  # a whole answer, as if it came of what is asked
FORGED = "writes to the exchange itself; only what a function returns counts"


def doing(text: str) -> str:
    """The right file, whose predict does something first."""
    lines = "".join(f"    {line}\n" for line in text.splitlines())
    return "import os, signal, sys, threading, time\n" + RIGHT.replace(HEAD, HEAD + lines)


def mine(line: int | None, wrong: str) -> re.Pattern[str]:
    """What is told of a line of it, or of the file: a pattern for the whole."""
    place = r"mine\.py" if line is None else rf"mine\.py:{line}"
    return re.compile(f"{place}: {wrong}" + r"\Z")


BROKEN = {  # the text, and what is told
    "endless loop": (doing("while True: pass"), mine(6, TOO_BUSY)),
    "endless loop that catches all": (
        doing("while True:\n    try:\n        while True: pass\n    except BaseException: pass"),
        mine(8, TOO_BUSY),
    ),
    "endless loop while it is read": ("while True: pass\n", mine(1, TOO_BUSY)),
    "deaf to one alarm": (
        doing("signal.signal(signal.SIGPROF, signal.SIG_IGN)\nwhile True: pass"),
        mine(7, TOO_BUSY),
    ),
    "deaf to alarms": (
        doing(
            "for name in ('PROF', 'XCPU', 'ALRM'):\n"
            "    signal.signal(getattr(signal, f'SIG{name}'), signal.SIG_IGN)\n"
            "while True: pass"
        ),
        mine(None, TOO_BUSY),
    ),
    "sleeps": (doing("time.sleep(60)"), mine(6, TOO_LONG)),
    "sleeps through alarms": (
        doing("signal.signal(signal.SIGALRM, signal.SIG_IGN)\ntime.sleep(60)"),
        mine(None, TOO_LONG),
    ),
    "stops itself": (doing("os.kill(os.getpid(), signal.SIGSTOP)"), mine(None, TOO_LONG)),
    "memory": (
        doing("rubbish = [np.empty(10**7) for _ in range(10**4)]"),
        mine(6, "MemoryError: Unable to allocate.*"),
    ),
    "status 0": (doing("sys.exit(0)"), mine(6, r".*exit\(0\).*")),
    "status 0 at once": (
        doing("os._exit(0)"),
        mine(None, "ended its process with status 0 instead of answering"),
    ),
    "status 0 while it is read": (
        "import os\nos._exit(0)\n",
        mine(None, "ended its process with status 0 instead of answering"),
    ),
    "exit in a thread": (
        doing(
            "thread = threading.Thread(target=os._exit, args=[3])\nthread.start()\nthread.join()"
        ),
        mine(None, "ended its process with status 3 instead of answering"),
    ),
    "kills itself": (doing("os.kill(os.getpid(), signal.SIGKILL)"), mine(None, "was killed: .*")),
    "crashes": (
        doing("import ctypes; ctypes.string_at(0)"),
        mine(None, "crashed: Segmentation fault"),
    ),
    "nan": (doing("return x * np.nan, P"), mine(5, r"x\[0\] is nan")),
    "not Python": ("def predict(:\n", mine(1, "this is not Python: invalid syntax")),
    "no update": (RIGHT.replace("def update", "def correct"), mine(None, "has no update.*")),
    "empty": ("", mine(None, "has no predict.* and no update.*")),
    "large file": (
        doing("open('big', 'wb').write(bytes(20 * 2**20))"),
        mine(6, "OSError:.*File too large"),
    ),
    "recursion": (doing("predict(x, P, u, motion)"), mine(6, "RecursionError: .*")),
    "list in list": (
        doing("nested = []\nfor _ in range(10**5): nested = [nested]\nreturn nested, P"),
        mine(5, "x is no array of numbers.*"),
    ),
    "huge array": (doing("return np.zeros(10**6), P"), mine(5, r"x has the shape \(1000000,\).*")),
    "array that raises": (
        doing("class Bad:\n    def __array__(self, *_, **__): raise SystemExit\nreturn Bad(), P"),
        mine(7, ".*exit.*"),
    ),
    "exception that raises": (
        doing("class Bad(Exception):\n    def __str__(self): raise Bad\nraise Bad"),
        mine(8, "Bad"),
    ),
    "endless exception": (doing("raise ValueError('x' * 10**7)"), mine(6, "ValueError: x{300}.*")),
    "controls": (
        doing(r"raise ValueError('\x1b[31m\0\n')"),
        mine(6, r"ValueError: \\x1b\[31m\\x00"),
    ),
    "junk on the exchange": (doing(EVERY.format("b'junk' * 100")), mine(None, FORGED)),
    "much junk on the exchange": (doing(EVERY.format("bytes(2**22)")), mine(None, FORGED)),
    "answers itself": (
        doing(
            "import struct\nanswer = struct.pack('<IB3x8s12d', 96, 1, bytes(8), *range(12))\n"
            + EVERY.format("answer")
        ),
        mine(None, FORGED),
    ),
    "answers for itself, with nan": (
        doing(MARKED + EVERY.format("head + struct.pack('<12d', *numbers[:11], np.nan)")),
        mine(None, "answers something else than was asked"),
    ),
    "answers for itself, with more": (
        doing(
            MARKED.replace("96", "104") + EVERY.format("head + struct.pack('<13d', *numbers, 0)")
        ),
        mine(None, "answers something else than was asked"),
    ),
    "answers for itself, with a place": (
        doing(MARKED.replace("96, 1", "96, 2") + EVERY.format("head + bytes(96)")),
        mine(None, FORGED),
    ),
    "half an answer": (
        doing(
            MARKED
            + EVERY.format("head")
            + "\nsignal.signal(signal.SIGALRM, signal.SIG_IGN)\ntime.sleep(60)"
        ),
        mine(None, TOO_LONG),
    ),
    "closes the exchange": (
        doing("os.closerange(3, 30)"),
        mine(None, "(ended its process with status 1|closed the exchange) instead of answering"),
    ),
    "closes the exchange and stays": (
        doing("os.closerange(3, 30)\ntime.sleep(60)"),
        mine(None, "closed the exchange instead of answering"),
    ),
    "no more of NumPy": (
        doing("np.array = np.asarray = np.stack = np.linalg = None"),
        re.compile(r"mine\.py(:7)?: .+\Z"),
    ),
}
HARMLESS = {  # what is answered is right all the same
    "prints much": doing("for _ in range(10**3): os.write(1, bytes(2**16))"),
    "prints in colour": doing(r"print('\x1b[31mred\x07')"),
    "prints an answer": doing("print([1.0] * 12)"),
    "closes what it prints to": doing("os.close(1); os.close(2); sys.stdout = sys.stderr = None"),
    "exit of a thread": doing(
        "thread = threading.Thread(target=sys.exit)\nthread.start()\nthread.join()"
    ),
    "goes elsewhere": doing("os.chdir('/')"),
    "no more of json": doing("import json, struct\njson.loads = json.dumps = struct.pack = None"),
    "deletes its folder": doing("import shutil; shutil.rmtree('.', ignore_errors=True)"),
    "warns": doing("np.zeros(1) / 0"),
}
