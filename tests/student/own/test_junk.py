"""Whatever a student's code gives back: a step or a fault of theirs, never a failure of ours."""

from contextlib import suppress

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from ekfsim.diagnostics.summary import Summary
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.protocol import Beginning
from ekfsim.localization import first_belief, localize
from ekfsim.simulation import simulate
from ekfsim.student.fault import FaultError
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.filter import OwnFilter
from ekfsim.student.own.forms import Functions
from ekfsim.student.own.home import Home
from ekfsim.student.own.loading import Code
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.playback.playback import views
from ekfsim.views.words.closing import conclude
from ekfsim.views.words.narrative.narrating import narrate

TOUR = load_scene("tour")
ENTRIES = list(simulate(TOUR))[:8]  # with moves, and beams that are read

numbers = st.one_of(
    st.floats(), st.integers(-(10**400), 10**400), st.complex_numbers(), st.booleans(), st.text(),
    st.none(), st.binary(),
)  # fmt: skip
shapes = st.sampled_from([(), (1,), (2,), (3,), (3, 1), (1, 3), (3, 3), (2, 2), (0,), (1, 3, 3)])
kinds = st.sampled_from(["f8", "f4", "i8", "u1", "c16", "?", "U3", "O", "M8[s]"])
whatever = st.one_of(
    numbers,
    st.lists(numbers, max_size=4),
    st.lists(st.lists(numbers, max_size=4), max_size=4),
    st.tuples(kinds, shapes).flatmap(lambda made: arrays(np.dtype(made[0]), made[1],
                                     elements=numbers if made[0] == "O" else None)),
    st.dictionaries(st.text(), numbers, max_size=2),
    st.just(np.ma.masked_all(3)),
)  # fmt: skip
means = arrays("f8", (3,), elements=st.floats(-1e308, 1e308))
spreads = st.one_of(
    arrays("f8", (3, 3), elements=st.floats(-size, size)).map(lambda L: L @ L.T)
    for size in (1e150, 1e12, 1.0, 1e-6, 1e-150)
)
returned = st.one_of(
    whatever, st.tuples(whatever, whatever), st.tuples(whatever, whatever, whatever),
    st.tuples(means, spreads), st.tuples(means, whatever), st.tuples(whatever, spreads),
)  # fmt: skip


@st.composite
def junk(draw):
    """Some of it; hypothesis tells what it was drawn from in a word."""
    return draw(st.lists(returned, min_size=1, max_size=4))


@settings(max_examples=100, deadline=None)
@given(junk())
def test_junk_is_a_fault_of_theirs(answers):
    coming = iter(answers * 8)
    code = Code("mine.py", Functions(lambda *_: next(coming), lambda *_: next(coming)), Home())
    beginning = Beginning(first_belief(TOUR))
    filter, told = OwnFilter.around(lambda: InProcess(code), beginning), []
    summary = Summary.of(TOUR)

    def steps():
        with suppress(FaultError):
            for step in localize(ENTRIES, filter, beginning.first):
                told.append(step)
                yield step

    for view in views(summary.following(steps())):
        narrate(view, TOUR, explain=True)
    conclude(summary)
    scopes.of(TOUR, told)
