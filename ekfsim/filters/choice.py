"""The filter that a scene names, as its run begins."""

from collections.abc import Mapping

from ekfsim.filters import FILTERS
from ekfsim.filters.place import forward
from ekfsim.filters.protocol import Beginning, Filter, Kind

GROUP = "ekfsim.filters"  # of entry points


def kind_of(name: str) -> Kind:
    """The filter of that name, built-in or registered, or at that place; see `verify`."""
    alone = forward(name)
    if alone in FILTERS:
        return FILTERS[alone]
    from ekfsim.student.own.choice import Own  # the door to filters of one's own

    return Own(alone)


def verify(name: str) -> None:
    """Raises UsageError where there is no such filter, FaultError where its code fails."""
    if forward(name) not in FILTERS:
        from ekfsim.student.own.choice import quietly

        quietly(forward(name))


def registered() -> list[str]:
    """The names under which installed packages register filters, none of which is loaded; built-in
    names win.
    """
    from importlib.metadata import entry_points

    return sorted({point.name for point in entry_points(group=GROUP)} - FILTERS.keys())


def brought() -> list[str]:
    """The names of the filters that were made of functions in this process."""
    from ekfsim.student.own.choice import brought as names

    return names()


def code_of(name: str) -> Mapping[str, bytes]:
    """The files that a filter of one's own is made of, by their names from its own folder; none
    of a built-in one. Raises what `verify` does.
    """
    if forward(name) in FILTERS:
        return {}
    from ekfsim.student.own.choice import contents

    return contents(forward(name))


def begun(name: str, beginning: Beginning) -> Filter:
    """The filter of that name for a run that begins so, in the counter-examples that its tuning
    asks for.
    """
    filter: Filter = kind_of(name).begin(beginning)
    if beginning.tuning.range_variance == "reading":
        from ekfsim.filters.variants.by_reading import NoiseByReading

        filter = NoiseByReading(filter)
    if beginning.tuning.cross_covariances == "dropped":
        from ekfsim.filters.variants.shadows import ShadowsAlone

        filter = ShadowsAlone(filter)
    return filter
