"""How often `ekfsim.why` names the cause of a run rightly, on scenes that no packaged input holds.

Each scene has one mechanism, shown to be the cause by taking it out: many runs end so with it, few
without. A run that ends so, and does not without it, is handed to `explain`, which is told nothing
else. "not found" is no mistake; a wrong name is.

python benchmarks/why.py [--runs 400] [--verify] [--only WORD]
"""

import argparse
import time
from collections import Counter
from dataclasses import replace

from held_out import cases
from held_out.cases import Case, Verified, verified

RIGHT, MISSED, WRONG = "right", "not found", "WRONG"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=400, help="of each scene, to show its cause")
    parser.add_argument("--verify", action="store_true", help="show the causes, and explain none")
    parser.add_argument("--only", default="", help="scenes of this mechanism or name alone")
    asked = parser.parse_args()
    chosen = [one for one in cases() if asked.only in one.name or asked.only in str(one.mechanism)]
    score: dict[str, Counter[str]] = {}
    for one in chosen:
        found = verified(one, asked.runs)
        told = f"{one.name:36s} {one.mechanism or 'none':27s} {one.outcome:14s}" + ending(found)
        if not asked.verify and found.run is not None:
            word, more = judged(one, found.run)
            score.setdefault(one.mechanism or "none", Counter())[word] += 1
            told += f"  {word:9s} {more}"
        print(told, flush=True)
    table(score)


def ending(found: Verified) -> str:
    """How often it ends so with its mechanism and without."""
    doubt = "" if found.holds else "  NOT SHOWN"
    return f" {found.with_it:6.1%} {found.without:6.1%} run {found.run}{doubt}"


def judged(one: Case, run: int) -> tuple[str, str]:
    """What `explain` makes of it: the word, and what else is to be seen."""
    from ekfsim.why import explain

    began = time.process_time()
    found = explain(replace(one.scene, run=run), runs=1000)
    causes = found.causes or (() if found.mechanism is None else (found.mechanism,))
    named = " + ".join(sorted(cause.value for cause in causes)) or None
    took = f"{found.replays} replays, {time.process_time() - began:.1f} s"
    cure = ", ".join(change.name for change in found.cure)
    if named == one.mechanism:
        return RIGHT, took
    return (MISSED if named is None else WRONG), f"{named}; {found.outcome}; cure: {cure}; {took}"


def table(score: dict[str, Counter[str]]) -> None:
    """Counts by mechanism, and of all."""
    words = (RIGHT, MISSED, WRONG)
    everything: Counter[str] = sum(score.values(), Counter())
    for name, counted in [*score.items(), ("all", everything)]:
        print(f"{name:27s}" + "".join(f" {counted[word]:3d} {word:9s}" for word in words))
    if total := everything.total():
        print(f"{everything[RIGHT] / total:.1%} right of {total}")


if __name__ == "__main__":
    main()
