"""What is asked → what was found: searched and shrunk on the draws of one seed, measured on those
of another, so that no luck of the search is told as a share.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from ekfsim.errors import RunError, StepError, UsageError
from ekfsim.hunting import goals
from ekfsim.hunting.changes.lists import Listed, Lists, Space
from ekfsim.hunting.changes.starts import Starts, begun, rounder
from ekfsim.hunting.changes.told import Needed, needed, untruly
from ekfsim.hunting.changes.variants import Commanded, Started, Variant
from ekfsim.hunting.crew import Judge, crew
from ekfsim.hunting.goals import Count, Goal
from ekfsim.hunting.search import Candidates, Search, Seen, searched
from ekfsim.hunting.shrinking import Shrunk, shrunk
from ekfsim.hunting.worlds import without
from ekfsim.scene import Expect, Scene
from ekfsim.seeds import MOST_SEED
from ekfsim.study.block import run_blocks
from ekfsim.study.expectation import NEES, NIS
from ekfsim.study.results import Result, Share
from ekfsim.twins import Way, taking

SEARCHING = 0.75  # of the seconds; the rest is for shrinking
Change = Literal["commands", "start", "told"]
ENOUGH = 0.5  # the share that a told number is to do, where nothing is said
End = Literal["lists", "best", "seconds", "interrupted"]


@dataclass(frozen=True)
class Asked:
    """What is hunted for, where, and how long."""

    scene: Scene  # with the commands that are begun with, if any; watched by the hunted filter
    goal: goals.Name | Literal["numbers"] = "lost"
    change: Change = "commands"
    against: str | None = None  # the filter that keeps its way, where two are told apart
    off: float = 0.1  # m from the truth, within which no run counts as lost
    moves: int = 8  # commands at most
    lists: int = 4000
    seconds: float = 60.0
    enough: float | None = None  # the share of runs that will do
    runs: int = 1000  # behind what is measured
    workers: int = 1
    way: Way = "quick"

    def counting(self) -> Goal:
        """The goal that counts runs. Raises UsageError where it lacks a filter."""
        match self.goal:
            case "lost":
                return goals.Lost(self.off)
            case "silent":
                return goals.Silent(self.off)
            case "apart":
                if self.against is None:
                    raise UsageError("--goal apart: name two filters: --for ekf,iekf")
                return goals.Apart(self.against, self.off)
            case "numbers":
                raise ValueError("numbers are compared in one run: exposing.py")


class OverError(Exception):
    """The clock ends the search within a round."""


@dataclass(frozen=True)
class Hunted:
    """What was found."""

    asked: Asked
    scene: Scene  # ready to be written: its seed is the fresh one, and it promises what it does
    search: Search
    end: End  # why the search ended
    is_shrunk: bool  # whether there was time to leave out all that may be
    count: Count  # of runs that do what is wanted, on the draws of the search
    fresh: Count  # and on fresh ones
    result: Result  # on fresh draws
    against: Result | None  # the same of the other filter
    needed: tuple[Needed, ...] = ()  # where a told number is changed: each, the smallest first


def hunt(asked: Asked, heard: Callable[[Search], None], heed: Callable[[], None]) -> Hunted:
    """The best that can be found. What `heed` raises ends the search with the best so far, or
    leaves where nothing was found yet.

    heard : hears of the search after each round
    """
    if asked.change == "told":
        return _told(asked, heed)
    candidates, first = _candidates(asked)
    state, shorter = Search(), None
    end: End = "lists"
    began = time.monotonic()

    def left(share: float) -> bool:
        return time.monotonic() - began < share * asked.seconds

    def heeding() -> None:
        heed()
        if searching and state.best and not left(1):  # a slow filter's round may be long
            raise OverError

    searching = True
    try:
        with crew(asked.workers, asked.counting(), asked.way, heeding) as judge:
            for state in searched(asked.scene, candidates, judge, asked.lists, first):
                heard(state)
                if _is_best(state, asked.enough):
                    end = "best"
                    break
                if state.looked_at < asked.lists and not left(SEARCHING):
                    end = "seconds"
                    break
            searching = False
            shorter = _less(asked, state.best[0].variant, judge, lambda: left(1))
    except OverError:
        end = "seconds"
    except (KeyboardInterrupt, SystemExit):
        if not state.best:
            raise
        end = "interrupted"
    return _held(asked, state, end, shorter)


def _held(asked: Asked, state: Search, end: End, shorter: Shrunk | None) -> Hunted:
    """What was found, measured. Raises RunError where no run does it."""
    looked, name = state.looked_at, asked.scene.world.name
    if not state.best[0].count.hits:
        raise RunError(
            f"{name}: no run of {looked} lists does that; look at more (--lists, --budget), allow "
            "more commands (--moves), or less error (--off)"
        )
    found = _measured(asked, state, end, shorter or _as_it_is(asked, state.best[0]))
    if not found.fresh.hits and end != "interrupted":
        raise RunError(
            f"{name}: the best of {looked} lists does that in {found.count.hits} of "
            f"{found.count.of} runs of the search, and in none of {found.fresh.of} fresh ones; "
            "look at more (--lists, --budget), or allow less error (--off)"
        )
    return found


def _candidates(asked: Asked) -> tuple[Candidates, list[Variant]]:
    """What is looked through, and what of it first."""
    scene = asked.scene
    if asked.change == "start":
        _refuse_where_no_start_is_sought(scene)
        return Starts(scene.world, scene.commands), []
    return Lists(Space(scene.world, asked.moves)), [Commanded(one) for one in begun_with(asked)]


def _less(asked: Asked, best: Variant, judge: Judge, go_on: Callable[[], bool]) -> Shrunk:
    """The best, shrunk."""
    scene = asked.scene
    if isinstance(best, Started):
        one, count = rounder(scene, Starts(scene.world, scene.commands), best, judge)
        return Shrunk(_begun(scene, one), scene.commands, count, True)
    assert isinstance(best, Commanded)
    space = Space(scene.world, asked.moves)
    listed = space.from_file(best.commands)
    return shrunk(scene, space, listed, judge, asked.enough, without, go_on)


def _as_it_is(asked: Asked, best: Seen) -> Shrunk:
    """The best where there is no time to shrink it."""
    match best.variant:
        case Started() as start:
            scene = _begun(asked.scene, start)
            return Shrunk(scene, scene.commands, best.count, False)
        case Commanded(commands):
            return Shrunk(asked.scene, commands, best.count, False)
    raise AssertionError


def _refuse_where_no_start_is_sought(scene: Scene) -> None:
    """Raises UsageError, before anything takes long."""
    if not len(scene.world.map.walls.boxes[0]):
        raise UsageError(
            f"{scene.world.name}: no wall says where a start may be; --change start looks in a room"
        )
    _begun(scene, Started(*scene.world.start.tolist()))


def _begun(scene: Scene, start: Started) -> Scene:
    found = begun(scene, start)
    if found is None:
        raise UsageError(
            f"{scene.world.name}: its `belief` tells the filter a start of its own; delete that"
        )
    return found


def _told(asked: Asked, heed: Callable[[], None]) -> Hunted:
    """The smallest change of one told number."""
    enough = asked.enough or ENOUGH
    end: End = "lists"
    found, began = list[Needed](), time.monotonic()
    try:
        with crew(asked.workers, asked.counting(), asked.way, heed) as judge:
            for one in needed(asked.scene, judge, enough):
                if one is not None:
                    found.append(one)
                if time.monotonic() - began >= asked.seconds:
                    end = "seconds"
                    break
    except (KeyboardInterrupt, SystemExit):
        if not found:
            raise
        end = "interrupted"
    if not found:
        tried = f" in the {asked.seconds:g} s of --budget" if end == "seconds" else ""
        raise RunError(
            f"{asked.scene.commands_source}: no told number was found{tried} that, changed by "
            f"itself, does that in {100 * enough:g} % of runs"
        )
    found.sort(key=lambda one: one.factor)
    scene = untruly(asked.scene, found[0].told)
    if scene is None:
        raise UsageError(f"{asked.scene.world.name}: its file cannot tell {found[0].told.key}")
    smallest = Shrunk(scene, scene.commands, found[0].count, True)
    return replace(_measured(asked, Search(), end, smallest), needed=tuple(found))


def begun_with(asked: Asked) -> list[Listed]:
    """The lists that are looked at first: what the scene does already."""
    space = Space(asked.scene.world, asked.moves)
    return [space.from_file(asked.scene.commands)] if asked.scene.commands else []


def _is_best(state: Search, enough: float | None) -> bool:
    """Whether more lists would make nothing better."""
    count = state.best[0].count
    return count.share == 1 or (enough is not None and Share(*count).low >= enough)


def _measured(asked: Asked, state: Search, end: End, found: Shrunk) -> Hunted:
    """What was found, on draws that the search has not seen."""
    seed = asked.scene.seed
    scene = replace(
        found.scene, commands=found.listed, seed=seed + 1 if seed < MOST_SEED else seed - 1,
        run=0, beside=(), expect=None,
    )  # fmt: skip
    with taking(asked.way):
        result = Result.alone(scene, run_blocks(scene, asked.runs))
        fresh = goals.counted(asked.counting(), scene, asked.runs)
        against = None
        if asked.against is not None:
            other = replace(scene, filter=asked.against)
            against = Result.alone(other, run_blocks(other, asked.runs))
    scene = replace(scene, expect=promise(result))
    return Hunted(asked, scene, state, end, found.whole, found.count, fresh, result, against)


def promised(scene: Scene, runs: int) -> Expect | None:
    """The promise of a scene that was not chosen by it; None where its filter fails in a run."""
    try:
        return promise(Result.alone(scene, run_blocks(scene, runs)))
    except StepError:
        return None


def promise(result: Result) -> Expect:
    """What a study of as many runs finds again: the interval of the share lost, and of NIS and NEES
    what is clear.
    """
    lost, of, runs = result.last.lost, result.tally.of, result.tally.runs
    nis = Share(of.nis_above + of.nis_below, runs)
    nees = Share(of.nees_above + of.nees_below, runs)
    return Expect(
        lost=(_down(lost.low), -_down(-lost.high)),
        nis="silent" if nis.high < NIS else "high" if Share(of.nis_above, runs).low > NIS
        else "low" if Share(of.nis_below, runs).low > NIS else None,
        nees="silent" if nees.high < NEES else "high" if Share(of.nees_above, runs).low > NEES
        else None,
        runs=runs,
    )  # fmt: skip


def _down(share: float) -> float:
    """Three decimals, none above."""
    return math.floor(1000 * share) / 1000
