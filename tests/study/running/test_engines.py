"""What a worker sends of a block that failed."""

import functools
import pickle

import pytest

from ekfsim.errors import StepError, UsageError
from ekfsim.student.fault import FaultError
from ekfsim.study.running.engines import Failed, do_packed, unfailed
from ekfsim.version import VERSION


class StrangeError(Exception):
    """Of a filter's file: no other process could unpack it."""

    def __reduce__(self):
        raise AssertionError("packed")


def fails(failure, first, runs):
    try:
        raise StrangeError
    except StrangeError as strange:
        raise failure from strange


def sent(failure):
    block = pickle.dumps(functools.partial(fails, failure))
    return pickle.loads(pickle.dumps(do_packed(block, 0, 1, VERSION)))


def test_a_fault_is_sent_in_words_alone():
    fault = (
        FaultError("mine.py:12", "nan in P; divide by no zero").at("step 7 (sense 90°)").in_run(3)
    )
    made = sent(fault)
    words = "mine.py:12: run 3, step 7 (sense 90°): nan in P; divide by no zero"
    assert made == Failed(words, at_a_step=True)
    with pytest.raises(StepError) as told:
        unfailed(made)
    assert (str(told.value), told.value.status) == (str(fault), 1)


def test_what_a_worker_lacks_is_told_of_the_worker():
    assert sent(UsageError("/home/anna/mine.py: no such file")) == Failed(
        "a worker cannot do this: /home/anna/mine.py: no such file"
    )


def test_a_mistake_of_our_own_keeps_its_traceback():
    with pytest.raises(ZeroDivisionError):
        sent(ZeroDivisionError())


def test_a_fault_is_packed_by_its_words():
    fault = FaultError("mine.py:12", "nan in P").in_run(3).at("step 7")
    again = pickle.loads(pickle.dumps(fault))
    assert (type(again), str(again)) == (FaultError, "mine.py:12: run 3, step 7: nan in P")
    assert (again.place, again.wrong, again.step, again.run) == (
        "mine.py:12",
        "nan in P",
        "step 7",
        3,
    )
