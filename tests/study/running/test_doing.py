import itertools

import pytest

from ekfsim.study.plan import Task
from ekfsim.study.running.doing import in_order, total

TASKS = [Task(case, block, 1024 * block, 1024) for case in range(2) for block in range(2)]


class Words:
    """A work whose blocks are letters, and whose sums show their order."""

    def block(self, case):
        return lambda first, runs: "abc"[first // 1024]


@pytest.mark.parametrize("come", [*itertools.permutations(TASKS)])
def test_blocks_are_put_together_in_the_order_of_their_tasks(come):
    assert [task for task, _ in in_order(TASKS, ((task, "") for task in come))] == TASKS


def test_no_block_waits_for_one_that_comes_later():
    """What is in order is handed on at once: the blocks of a long study are not gathered."""
    blocks = iter([(TASKS[1], "b"), (TASKS[0], "a"), (TASKS[2], "c")])
    handed_on = in_order(TASKS, blocks)
    assert [next(handed_on)[1], next(handed_on)[1]] == ["a", "b"]
    assert next(blocks) == (TASKS[2], "c")


def test_a_total_hears_of_blocks_as_they_come_and_adds_them_in_order():
    tasks, come = [Task(0, block, 1024 * block, 1024) for block in range(3)], []

    def backwards(work, tasks):
        for task in reversed(list(tasks)):
            yield task, work.block(task.case)(task.first, task.runs)

    found = total(Words(), iter(tasks), backwards, lambda task, made: come.append(made))
    assert (found, come) == ("abc", ["c", "b", "a"])
