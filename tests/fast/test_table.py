"""The one test of the twins: each row of the table is equal to its text, whatever it is given.

To add a twin:

1. mark the function of the text `@twinned`;
2. write the twin, of the same arguments, somewhere in ekfsim/fast/: one/, many/ or compiled/.
   It returns None where it sees that it does not suit, and it sees that cheaply;
3. put a row into `TWINS` in ekfsim/fast/table.py, the quickest of one text first;
4. give it something to chew on: a function marked `@inputs("module:function")` in one of the files
   tests/fast/inputs_*.py (see twin_inputs.py). Let there be among it whatever may come: singular P,
   nan, σ = 0, headings at ±π.

A row without inputs fails here, and so does a twin that never answers.
"""

import copy
import dataclasses
import glob
import importlib
import inspect
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from twin_inputs import INPUTS, RUNS

from ekfsim import twins
from ekfsim.fast.table import TWINS, function

for file in sorted(glob.glob(str(Path(__file__).parent / "inputs_*.py"))):
    importlib.import_module(Path(file).stem)

SEEDS = range(3)  # of a thousand runs one: they are cases enough
ROWS = [
    pytest.param(
        twin,
        id=f"{twin.of.removeprefix('ekfsim.')}={twin.form.removeprefix('ekfsim.fast.')}",
        marks=pytest.mark.skipif(
            twin.compiled and not twins.compiles(), reason="the extra `fast` is not installed"
        ),
    )
    for twin in TWINS
]


@pytest.mark.parametrize("twin", ROWS)
def test_a_twin_is_its_text(twin):
    assert (twin.of, twin.given) in INPUTS, f"no inputs for {twin.of} {twin.given}, see above"
    source, form, text = INPUTS[twin.of, twin.given], function(twin.form), function(twin.of).text
    answers = 0
    for runs in RUNS:
        for seed in SEEDS[:1] if runs == max(RUNS[1:]) else SEEDS:
            for n, args in enumerate(source.make(np.random.default_rng(seed), runs)):
                at = f"{runs} runs, seed {seed}, input {n}"
                before = copy.deepcopy(args)
                with twins.taking("compiled" if twin.compiled else "quick"):
                    told = whole(form(*args))
                if not source.filled:
                    assert differences(args, before, 0.0, "argument") == [], at
                if told is None:
                    continue
                answers += 1
                with twins.taking("plain"):
                    right = whole(text(*before))
                if source.filled:
                    assert differences(args[0], before[0], source.within, "filled", runs) == [], at
                assert differences(told, right, source.within, "result", runs) == [], at
    assert answers, "it never answers"


@pytest.mark.parametrize("twin", TWINS)
def test_a_row_names_what_is_there(twin):
    text = function(twin.of)
    assert inspect.isroutine(text)
    assert f"{text.text.__module__}:{text.text.__qualname__}" == twin.of
    assert twin.when
    if not twin.compiled or twins.compiles():
        assert inspect.isroutine(function(twin.form))


def whole(answer):
    """What was answered; of an iterator all that comes of it."""
    return list(answer) if isinstance(answer, Iterator) else answer


def differences(told, right, within, name, runs=None):
    """In which parts of a result twin and text differ, and by how much: nothing where they are
    equal.

    Numbers to `within` of the largest of the same part in the same run, all else to the letter.
    """
    if dataclasses.is_dataclass(right):
        names = [field.name for field in dataclasses.fields(right)]
        pairs = [(one, getattr(told, one), getattr(right, one)) for one in names]
    elif isinstance(right, tuple | list):
        if len(told) != len(right):
            return [f"{name}: {len(told)} parts in place of {len(right)}"]
        names = getattr(right, "_fields", range(len(right)))
        pairs = list(zip(names, told, right, strict=True))
    elif isinstance(right, dict):
        if list(told) != list(right):
            return [f"{name}: of {list(told)} in place of {list(right)}"]
        pairs = [(one, told[one], part) for one, part in right.items()]
    elif isinstance(right, np.ndarray | float | int | bool):
        return _numbers(np.asarray(told), np.asarray(right), within, name, runs)
    elif type(right).__eq__ is object.__eq__ and getattr(right, "__dict__", None):
        pairs = [(one, getattr(told, one), part) for one, part in vars(right).items()]
    else:
        return [] if told is right or told == right else [f"{name}: {told!r}, not {right!r}"]
    return [
        different
        for part, one, other in pairs
        for different in differences(one, other, within, f"{name}.{part}", runs)
    ]


def _numbers(told, right, within, name, runs):
    if told.shape != right.shape:
        return [f"{name}: shape {told.shape}, not {right.shape}"]
    if right.dtype.kind != "f":
        wrong = np.flatnonzero(told.ravel() != right.ravel())
    else:
        odd = ~np.isfinite(right)
        sizes = np.where(odd, 0.0, np.abs(right))
        by_run = runs is not None and sizes.ndim > 0 and len(sizes) == runs
        axes = tuple(range(1, sizes.ndim)) if by_run else None
        scale = sizes.max(axes, initial=0.0, keepdims=True)
        same = np.isclose(told, right, rtol=0, atol=0, equal_nan=True)
        with np.errstate(invalid="ignore"):
            near = ~odd & (np.abs(told - right) <= within * scale)
        wrong = np.flatnonzero(~(same | near).ravel())
    if not len(wrong):
        return []
    i = wrong[0]
    return [f"{name}: {told.ravel()[i]!r}, not {right.ravel()[i]!r}, {len(wrong)} such"]
