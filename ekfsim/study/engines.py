"""Where blocks run: here, in processes of this machine, or on a cluster. Each engine yields them as they are done."""

import contextlib
import functools
import itertools
import os
import pickle
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import active_children, connection, get_context, parent_process
from typing import Any

from ekfsim.errors import RunError
from ekfsim.scene import Scene
from ekfsim.study.block import run_block
from ekfsim.study.plan import Plan, Task
from ekfsim.study.tally import Tally
from ekfsim.version import VERSION

Done = tuple[Task, Tally]
Engine = Callable[[Plan, Iterable[Task]], Iterator[Done]]
AHEAD = 3  # blocks for each worker that are handed out at once, so that none waits


def serial(plan: Plan, tasks: Iterable[Task]) -> Iterator[Done]:
    """One block after another, in this process."""
    for task in tasks:
        yield task, run_block(plan.cases[task.case].scene, task.first, task.runs)


def work(packed: bytes, first: int, runs: int, version: str) -> Tally:
    """A block, wherever this is called. Raises RunError where another version of ekfsim is installed."""
    if version != VERSION:
        raise RunError(f"a worker has ekfsim {VERSION}, and this is {version}; install the same version there")
    return run_block(_unpacked(packed), first, runs)


@functools.lru_cache(maxsize=8)
def _unpacked(packed: bytes) -> Scene:
    """The scene in a parcel, unpacked once: its walls are made ready once for all of its blocks."""
    scene: Scene = pickle.loads(packed)
    return scene


class Parcels:
    """The scenes of a plan, packed to be sent; those of the case in work are kept."""

    def __init__(self, plan: Plan) -> None:
        self._packed = functools.lru_cache(maxsize=8)(lambda case: pickle.dumps(plan.cases[case].scene))

    def __call__(self, task: Task) -> tuple[bytes, int, int, str]:
        """The arguments of `work` for a task."""
        return self._packed(task.case), task.first, task.runs, VERSION


def pool(workers: int) -> Engine:
    """An engine of processes on this machine."""

    def engine(plan: Plan, tasks: Iterable[Task]) -> Iterator[Done]:
        before = set(active_children())
        waiting, parcels = iter(tasks), Parcels(plan)
        with _one_thread_each():
            executor = ProcessPoolExecutor(workers, get_context("spawn"), initializer=_begin_worker)
        try:
            running: dict[Future[Tally], Task] = {}
            for task in itertools.islice(waiting, AHEAD * workers):
                with _one_thread_each():  # processes are made as blocks come
                    running[executor.submit(work, *parcels(task))] = task
            while running:
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(future), future.result()
                    for task in itertools.islice(waiting, 1):
                        running[executor.submit(work, *parcels(task))] = task
        except BrokenProcessPool:
            raise RunError("a worker process died: it was killed, or there is too little memory for so many") from None
        finally:
            executor.shutdown(wait=False, cancel_futures=True)
            for child in set(active_children()) - before:
                child.terminate()

    return engine


@contextlib.contextmanager
def _one_thread_each() -> Iterator[None]:
    """Processes that begin in this block calculate with one thread each: there are as many as there are cores."""
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


def _begin_worker() -> None:
    """A worker leaves interrupts to its parent, and does not outlive it."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()
    assert parent is not None

    def leave_with(sentinel: Any) -> None:
        connection.wait([sentinel])
        os._exit(1)

    threading.Thread(target=leave_with, args=(parent.sentinel,), daemon=True).start()
