"""Blocks on the workers of a Dask scheduler, which may come, go and die."""

import itertools
import logging
import socket
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from ekfsim.errors import RunError, UsageError
from ekfsim.study.plan import Task
from ekfsim.study.running.engines import Engine, Parcels, T, Work, do_packed, unfailed

SECONDS = 10  # for a scheduler that does not answer
GREETING = 1_000_000  # bytes; a scheduler speaks first, and begins by saying how many
RETRIES = 3  # of a block whose worker failed or died
AHEAD = 4  # blocks for each worker that are handed out at once


def cluster(address: str, tell: Callable[[str], None]) -> Engine:
    """An engine of the workers of a scheduler. Raises UsageError without `distributed`, RunError
    where none answers.
    """
    try:
        import dask
        import distributed
    except ImportError:
        raise UsageError(
            "--cluster needs the package 'distributed': pip install 'ekfsim[cluster]'"
        ) from None
    for name in list(logging.root.manager.loggerDict):  # they tell at length what we say in a line
        if name.partition(".")[0] in ("distributed", "tornado", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    limits = {"distributed.comm.timeouts.connect": f"{SECONDS}s", "distributed.comm.retry.count": 0}

    def engine(work: Work[T], tasks: Iterable[Task]) -> Iterator[tuple[Task, T]]:
        with dask.config.set(limits):
            client = _connected(distributed, address)
            try:
                yield from _done(distributed, client, work, tasks, tell)
            except (
                distributed.client.FutureCancelledError,
                distributed.comm.core.CommClosedError,
                TimeoutError,
            ):
                raise RunError(f"the scheduler at {address} is gone") from None
            except ModuleNotFoundError as lack:
                raise RunError(
                    f"a worker lacks {lack.name}; install ekfsim there as here"
                ) from None
            except distributed.KilledWorker:
                raise RunError("a block was given up, as every worker that began it died") from None
            finally:
                client.close(timeout=1)

    return engine


def _connected(distributed: Any, address: str) -> Any:
    """A client of a scheduler. That something listens is seen first, for the client would try for
    half a minute.
    """
    scheme, _, rest = address.rpartition("://")
    host, _, port = rest.rpartition(":")
    if scheme not in ("", "tcp", "tls") or not host or not port.isdigit():
        raise UsageError(
            f"--cluster {address}: is no address of a scheduler; write e.g. tcp://127.0.0.1:8786"
        )
    try:
        with socket.create_connection((host.strip("[]"), int(port)), timeout=SECONDS) as wire:
            if (
                scheme != "tls"
                and not 0 < int.from_bytes(wire.recv(8, socket.MSG_WAITALL), "little") < GREETING
            ):
                raise RunError(f"no scheduler at {address}: something else answers there")
        return distributed.Client(address, timeout=SECONDS, set_as_default=False)
    except (OSError, OverflowError, UnicodeError, TimeoutError) as error:
        why = (
            f"{error.strerror}"
            if isinstance(error, OSError) and error.strerror
            else "it does not answer"
        )
        raise RunError(
            f"no scheduler at {address}: {why}; start one with `dask scheduler`"
        ) from None
    except (ValueError, TypeError, RuntimeError) as error:
        raise UsageError(f"--cluster {address}: {error}") from None


def _done(
    distributed: Any, client: Any, work: Work[T], tasks: Iterable[Task], tell: Callable[[str], None]
) -> Iterator[tuple[Task, T]]:
    """The blocks as they are done, no more of them handed out than the workers need."""
    workers = len(client.scheduler_info(n_workers=-1)["workers"])
    if workers == 0:
        tell(f"no worker has come yet; start some with `dask worker {client.scheduler.address}`")
    waiting, parcels = iter(tasks), Parcels(work)
    running: dict[str, Task] = {}
    ready = distributed.as_completed(loop=client.loop, raise_errors=False)

    def hand_out(many: int) -> None:
        for task in itertools.islice(waiting, many):
            future = client.submit(do_packed, *parcels(task), pure=False, retries=RETRIES)
            running[future.key] = task
            ready.add(future)

    hand_out(AHEAD * max(workers, 8))
    for future in ready:
        yield running.pop(future.key), unfailed(future.result())
        hand_out(1)
