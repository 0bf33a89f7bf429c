"""What inputs expose, for a person: of one input where each mistake shows first; of several a
column each.
"""

from collections.abc import Iterator, Mapping, Sequence

from ekfsim.printable import in_a_line, some
from ekfsim.student.comparing.difference import SURELY
from ekfsim.student.exposing.exposed import Exposed
from ekfsim.student.exposing.statistics import seen
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.study.results import Result
from ekfsim.views.words.numbers import number
from ekfsim.views.words.text_table import aligned, folded

MOST = 24  # names in a sentence; the table has them all
RIGHT = "(no mistake)"
FIRST = ("mistake", "shows first at", "in", "it says", "right is", "σ")
STATISTICS = ("> 50 %", "lost", "NIS", "statistics say")


def of_one(
    name: str,
    found: Sequence[Exposed],
    right: Result | None = None,
    statistics: Mapping[Mistake, Result] | None = None,
    width: int | None = None,
) -> str:
    """Where each mistake shows first.

    right, statistics : of the filter without a mistake and with each, where they were asked for
    """
    rows: list[tuple[str, ...]] = [FIRST if right is None else (*FIRST, *STATISTICS)]
    if right is not None:
        rows.append((RIGHT, *[""] * (len(FIRST) - 1), *_judged(right)))
    for one in found:
        judged = _judged(statistics[one.mistake]) if statistics else ()
        if one.first is not None:
            rows.append((one.mistake.name, *_first(one), *judged))
    lines = [
        *folded(f"{in_a_line(name)}: {_counted(found)} (below in m and rad)", width),
        "",
        *(aligned(rows, 3, width) if len(rows) > 1 else ()),
        *_not_exposed([found], width),
        *(_unseen(found, right, statistics, width) if right and statistics else ()),
    ]
    return "".join(f"{line}\n" for line in lines)


def of_several(
    names: Sequence[str], found: Sequence[Sequence[Exposed]], width: int | None = None
) -> str:
    """The kill matrix: of each mistake the first step of each input at which it shows."""
    together = [first_of(rows) for rows in zip(*found, strict=True)]
    lines = [f"{i}  {in_a_line(name)}: {_counted(rows)}" for i, (name, rows) in
             enumerate(zip(names, found, strict=True), 1)]  # fmt: skip
    head = ("mistake", *(str(i) for i in range(1, len(names) + 1)))
    rows = [
        (of_all[0].mistake.name, *(_step(one) for one in of_all))
        for of_all in zip(*found, strict=True)
    ]
    lines += [
        f"together: {_counted(together)}",
        "",
        "The first step at which each shows (·: it never does; -: it cannot be made there)",
        *aligned([head, *rows], 1, width),
        *_not_exposed(found, width),
    ]
    return "".join(f"{line}\n" for line in lines)


def first_of(rows: Sequence[Exposed]) -> Exposed:
    """One mistake in several inputs, as the first of them has it that exposes it."""
    return next(
        (one for one in rows if one.first is not None),
        next((one for one in rows if one.possible), rows[0]),
    )


def _counted(found: Sequence[Exposed]) -> str:
    possible = [one for one in found if one.possible]
    shown = sum(one.first is not None for one in possible)
    return f"exposes {shown} of the {len(possible)} known mistakes that can be made with it"


def _first(one: Exposed) -> tuple[str, ...]:
    assert one.first is not None
    most = one.first.most
    size = f"> {SURELY}" if most.size > SURELY else f"{most.size:.3g}"
    return one.first.asked.step, most.entry, number(most.theirs), number(most.right), size


def _step(one: Exposed) -> str:
    return str(one.first.asked.index) if one.first else "·" if one.possible else "-"


def _judged(result: Result) -> tuple[str, ...]:
    last = result.last
    shares = (f"{100 * share.value:.0f}" for share in (last.above_50, last.lost))
    return (*shares, f"{result.nis.value:.3g}", seen(result) or "nothing")


def _not_exposed(found: Sequence[Sequence[Exposed]], width: int | None) -> Iterator[str]:
    together = [first_of(rows) for rows in zip(*found, strict=True)]
    missed = [one.mistake for one in together if one.possible and one.first is None]
    if missed:
        yield from ("", "Not exposed:")
        for mistake in missed:
            yield from folded(f"  {mistake.name}: {mistake.told}", width)
    beyond = [one.mistake.name for one in together if not one.possible]
    if beyond:
        yield ""
        yield from folded(f"Cannot be made here: {some(beyond, MOST)}", width)


def _unseen(
    found: Sequence[Exposed], right: Result, statistics: Mapping[Mistake, Result],
    width: int | None,
) -> Iterator[str]:  # fmt: skip
    """How many of the exposed mistakes statistics do not see."""
    exposed = [one.mistake for one in found if one.first is not None]
    unseen = [one.name for one in exposed if seen(statistics[one]) == seen(right)]
    told = f"Of {right.tally.runs} runs statistics alone say of {len(unseen)} of these what they "
    told += f"say of the right filter{': ' if unseen else ''}{some(unseen, MOST)}"
    yield from ("", *folded(told, width))
