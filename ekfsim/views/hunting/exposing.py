"""What exposes a filter → sentences: the input, and the first wrong number in it."""

from collections.abc import Sequence
from pathlib import Path

from ekfsim.filters.place import label
from ekfsim.hunting.exposing import Exposure
from ekfsim.printable import in_a_line
from ekfsim.provenance import told_in_a_line
from ekfsim.student.comparing.naming import At
from ekfsim.views.hunting.words import told
from ekfsim.views.student import difference
from ekfsim.views.words.text_table import folded


def conclude(one: Exposure, against: str, files: Sequence[Path], width: int | None) -> str:
    """All that is said of it. files : that were written"""
    name = label(one.scene.filter)
    sides = difference.Sides(
        name, label(against), f"{told_in_a_line(one.scene)}, against {against}"
    )
    lines = [
        *folded(in_a_line(headline(one, against)), width),
        *(f"  {told(command)}" for command in one.scene.commands),
    ]
    last = folded(in_a_line(f"{files[0]}: {held(one, against, files[0])}"), width)
    return "".join(
        [*(f"{line}\n" for line in lines), difference.told(one.found, sides),
         *(f"{line}\n" for line in last)]
    )  # fmt: skip


def headline(one: Exposure, against: str) -> str:
    """Which input it is."""
    n = len(one.scene.commands)
    what = f"{n} command{'' if n == 1 else 's'} in {one.scene.world.name}"
    return f"{what}: {label(one.scene.filter)} {_first(one)}; {label(against)} is right"


def _first(one: Exposure) -> str:
    first = one.found.first
    if first is None:
        return f"fails: {in_a_line(str(one.found.fault))}"
    return f"has its first wrong number at {_where(first)}"


def _where(at: At) -> str:
    most = at.step.most
    return f"{at.step.asked.step}, {most.entry} = {most.theirs:.6g} and not {most.right:.6g}"


def held(one: Exposure, against: str, file: Path) -> str:
    """The command line that shows it."""
    beside = "" if against == "ekf" else f" --against {label(against)}"
    return f"ekfsim diff {file} --filter {label(one.scene.filter)}{beside} shows it"
