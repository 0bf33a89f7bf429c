"""Where blocks run: here, in processes of this machine, or on a cluster. Each engine yields them as
they are done.
"""

import contextlib
import functools
import itertools
import os
import pickle
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import active_children, connection, get_context, parent_process
from typing import Any, NamedTuple, Protocol, TypeVar

from ekfsim.errors import EkfsimError, RunError, StepError, UsageError
from ekfsim.study.plan import Task
from ekfsim.version import VERSION

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)
SECONDS = 1.0  # for a thread that ends as the processes do
AHEAD = 3  # blocks for each worker that are handed out at once, so that none waits


class Work(Protocol[T_co]):
    """What is done in blocks of runs: a study, a comparison."""

    def block(self, case: int) -> Callable[[int, int], T_co]:
        """What becomes of runs of a case: a function of the first and of how many, that can be
        packed and sent.
        """


class Engine(Protocol):
    """Does blocks somewhere, and yields them as they are done."""

    def __call__(self, work: Work[T], tasks: Iterable[Task]) -> Iterator[tuple[Task, T]]:
        """What becomes of each task, in any order."""


def serial(work: Work[T], tasks: Iterable[Task]) -> Iterator[tuple[Task, T]]:
    """One block after another, in this process."""
    for task in tasks:
        yield task, work.block(task.case)(task.first, task.runs)


class Paced:
    """An engine, and how many runs it does a second."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._runs = 0
        self._began = self._last = time.monotonic()

    def __call__(self, work: Work[T], tasks: Iterable[Task]) -> Iterator[tuple[Task, T]]:
        """What becomes of each task, as the engine has it."""
        self._began = time.monotonic()
        for task, made in self._engine(work, tasks):
            self._runs += task.runs
            self._last = time.monotonic()
            yield task, made

    @property
    def pace(self) -> float:
        """Runs a second, the start of workers and of compiled code included; 0 where none was
        done.
        """
        return self._runs / (self._last - self._began) if self._runs else 0.0


class Failed(NamedTuple):
    """Why a block failed, in words. They alone are sent: an exception brings others along, whose
    classes may be those of a filter's file, and no program unpacks what it does not know.
    """

    told: str
    at_a_step: bool = False  # of a run: the code of a filter failed


def do_packed(packed: bytes, first: int, runs: int, version: str, *more: Any) -> Any:
    """A block, or how it `Failed`, wherever this is called. Raises RunError where another version
    of ekfsim is installed.

    more : what the block is told besides its runs
    """
    if version != VERSION:
        raise RunError(
            f"a worker has ekfsim {VERSION}, and this is {version}; install the same version there"
        )
    try:
        return _unpacked(packed)(first, runs, *more)
    except UsageError as lack:
        return Failed(f"a worker cannot do this: {lack}")
    except EkfsimError as failure:
        return Failed(str(failure), isinstance(failure, StepError))
    except ModuleNotFoundError as missing:
        raise RunError(f"a worker cannot do this: {missing}") from missing


def unfailed(made: T | Failed) -> T:
    """What a worker sent, where it is a block. Raises RunError where that failed, StepError where
    a run did.
    """
    if isinstance(made, Failed):
        raise (StepError if made.at_a_step else RunError)(*made.told.split("\n"))
    return made


@functools.lru_cache(maxsize=8)
def _unpacked(packed: bytes) -> Callable[..., Any]:
    """What is in a parcel, unpacked once: the walls of its scene are made ready once for all of its
    blocks.
    """
    block: Callable[..., Any] = pickle.loads(packed)
    return block


class Parcels:
    """The cases of a work, packed to be sent; those that are done just now are kept."""

    def __init__(self, work: Work[Any]) -> None:
        self._packed = functools.lru_cache(maxsize=8)(lambda case: pickle.dumps(work.block(case)))

    def __call__(self, task: Task) -> tuple[bytes, int, int, str]:
        """The arguments of `do_packed` for a task."""
        return self._packed(task.case), task.first, task.runs, VERSION


def pool(workers: int) -> Engine:
    """An engine of processes on this machine."""

    def engine(work: Work[T], tasks: Iterable[Task]) -> Iterator[tuple[Task, T]]:
        waiting, parcels = iter(tasks), Parcels(work)
        running: dict[Future[T | Failed], Task] = {}
        with processes(workers) as submit:

            def hand_out(many: int) -> None:
                for task in itertools.islice(waiting, many):
                    running[submit(do_packed, *parcels(task))] = task

            hand_out(AHEAD * workers)
            while running:
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(future), unfailed(future.result())
                    hand_out(1)

    return engine


@contextlib.contextmanager
def processes(workers: int) -> Iterator[Callable[..., "Future[Any]"]]:
    """Processes of this machine, to which a function and its arguments are submitted; none of them
    is left behind. Raises RunError where one dies.
    """
    before, threads = set(active_children()), set(threading.enumerate())
    with one_thread_each():
        executor = ProcessPoolExecutor(workers, get_context("spawn"), initializer=_begin_worker)

    def submit(function: Callable[..., Any], *args: Any) -> "Future[Any]":
        # processes are made as work comes
        with _heeding_signals_later(), one_thread_each():
            return executor.submit(function, *args)

    try:
        yield submit
    except BrokenProcessPool:
        raise RunError(
            "a worker process died: it was killed, or there is too little memory for so many"
        ) from None
    finally:
        executor.shutdown(wait=False, cancel_futures=True)
        for child in set(active_children()) - before:
            child.terminate()
        for thread in set(threading.enumerate()) - threads:
            # one that was just made and has not begun cannot be joined
            with contextlib.suppress(RuntimeError):
                # else one of them may still be at work when all else is torn down
                thread.join(SECONDS)


@contextlib.contextmanager
def one_thread_each() -> Iterator[None]:
    """Processes that begin in this block calculate with one thread each: there are as many as there
    are cores.
    """
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    held = {name: os.environ.get(name) for name in names}
    os.environ.update(dict.fromkeys(names, "1"))
    try:
        yield
    finally:
        for name, value in held.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextlib.contextmanager
def _heeding_signals_later() -> Iterator[None]:
    """What asks us to end is heeded after this block: then all processes that begin in it are
    known, and end with us.

    They themselves hear no Ctrl-C before `_begin_worker` has told them to leave it to us.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    numbers = [
        getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
    ]
    handlers = {number: signal.getsignal(number) for number in numbers}
    mask = getattr(signal, "pthread_sigmask", None)  # Windows has none
    heard = mask(signal.SIG_BLOCK, {signal.SIGINT}) if mask else None
    try:
        for number, handler in handlers.items():
            if callable(handler):  # what is ignored stays ignored
                signal.signal(number, lambda number, _: came.append(number))
        yield
    finally:
        for number, handler in handlers.items():
            if callable(handler):
                signal.signal(number, handler)
        if mask:
            mask(signal.SIG_SETMASK, heard)
        if came:
            signal.raise_signal(came[0])


def _begin_worker() -> None:
    """A worker leaves interrupts to its parent, and does not outlive it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def leave_with(sentinel: Any) -> None:
        connection.wait([sentinel])
        os._exit(1)

    if (parent := parent_process()) is not None:
        threading.Thread(target=leave_with, args=(parent.sentinel,), daemon=True).start()
