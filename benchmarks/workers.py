"""A study on two processes against one, in turn, on the same machine: python benchmarks/workers.py
[RUNS]

Other programs disturb it: run it where two cores are idle.
"""

import statistics
import sys
import time
from dataclasses import replace

from ekfsim.files.scenes.load_study import read_request
from ekfsim.study.plan import Plan
from ekfsim.study.running.doing import total
from ekfsim.study.running.engines import Engine, pool, serial

ROUNDS = 3
RUNS = 400_000


def seconds(plan: Plan, engine: Engine) -> float:
    """How long all blocks of a study of one case take, processes started and ended."""
    start = time.perf_counter()
    total(plan, plan.tasks(), engine, lambda task, tally: None)
    return time.perf_counter() - start


def main() -> None:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else RUNS
    plan = Plan.of(replace(read_request("tour"), runs=runs))
    ratios = []
    for _ in range(ROUNDS):
        one, two = seconds(plan, serial), seconds(plan, pool(2))
        ratios.append(one / two)
        print(
            f"{runs} runs of the tour: one process {one:.1f} s, two {two:.1f} s: {one / two:.2f} "
            f"times as fast"
        )
    print(f"median: {statistics.median(ratios):.2f} times as fast")


if __name__ == "__main__":
    main()
