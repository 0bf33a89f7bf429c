"""The draws of one run, the generators of many of them seeded together.

NumPy seeds a generator from some words by a hash that is the same for whatever words there are. So
the draws i, i + 1, … of a run, one word of which differs, are hashed side by side in arrays, and
one generator is set to the state that each leads to. Its numbers are NumPy's to the last bit.

M. E. O'Neill: PCG, Technical report HMC-CS-2014-0905, 2014, and the hash of its `randutils`, as
NumPy's SeedSequence and PCG64 have them.
"""

import threading
from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ekfsim.simulation.draws import BLOCK

Words = NDArray[np.uint32]

FEW = 16  # draws that are sooner seeded one by one
TOGETHER = 256  # draws that are seeded together
WORD, LARGE = 2**32 - 1, 2**128 - 1  # the largest number of 32 bits, and of 128
HALF = np.uint32(16)  # bits
POOL = 4  # words that a seed is hashed into
# SeedSequence: where a hash begins, and what it is multiplied by at each word; what mixes two words
ENTERING, LEAVING = (0x43B0D7E5, 0x931E8875), (0x8B51F9DD, 0x58F38DED)
MIX_LEFT, MIX_RIGHT = np.uint32(0xCA01F9DD), np.uint32(0x4973F715)
STEP = 0x2360ED051FC65DA44385DF649FCCF645  # PCG64: state ← state · STEP + increment


class Own(threading.local):
    """The generator that is set to one state after another, each thread's own."""

    def __init__(self) -> None:
        self.bits = np.random.PCG64(0)
        self.generator = np.random.Generator(self.bits)


OWN = Own()


def draw(
    seed: int, i: int, run: int, uniforms: bool
) -> tuple[Sequence[float], Sequence[float]] | None:
    """The normals and uniforms of draw i of one run."""
    b, row = divmod(run, BLOCK)
    if not FEW <= i <= WORD - TOGETHER or b > WORD:
        return None
    together, own = divmod(i, TOGETHER), OWN
    state, increment = state_of(*seeds(seed, together[0], b)[together[1]])
    own.bits.state = {
        "bit_generator": "PCG64",
        "state": {"state": state, "inc": increment},
        "has_uint32": 0,
        "uinteger": 0,
    }
    if not uniforms:
        return own.generator.standard_normal(4 * (row + 1))[4 * row :].tolist(), ()
    normals = own.generator.standard_normal((BLOCK, 4))[row].tolist()
    return normals, own.generator.random((BLOCK, 2))[row].tolist()


@lru_cache(maxsize=8)
def seeds(seed: int, stretch: int, b: int) -> list[tuple[int, int, int, int]]:
    """SeedSequence([seed, i, b]).generate_state(4, uint64) of TOGETHER draws i that follow one
    another.
    """
    numbers = np.arange(stretch * TOGETHER, (stretch + 1) * TOGETHER, dtype=np.uint32)
    enter, leave = _hash(*ENTERING), _hash(*LEAVING)
    words = [np.full_like(numbers, seed), numbers, np.full_like(numbers, b), 0 * numbers]
    pool = [enter(word) for word in words]
    for source in range(POOL):
        for into in range(POOL):
            if into != source:
                pool[into] = _mixed(pool[into], enter(pool[source]))
    left = [leave(pool[k % POOL]).astype(np.uint64) for k in range(2 * POOL)]
    pairs = zip(left[::2], left[1::2], strict=True)
    whole = [(low | high << np.uint64(32)).tolist() for low, high in pairs]
    return list(zip(*whole, strict=True))


def state_of(high: int, low: int, stream_high: int, stream_low: int) -> tuple[int, int]:
    """PCG64's state and increment, of the four words that it is seeded with."""
    increment = (stream_high << 65 | stream_low << 1 | 1) & LARGE
    return ((increment + (high << 64 | low)) * STEP + increment) & LARGE, increment


def _hash(beginning: int, factor: int) -> Callable[[Words], Words]:
    """SeedSequence's hash of one word after another."""
    constant = beginning

    def hashed(word: Words) -> Words:
        nonlocal constant
        word = word ^ np.uint32(constant)
        constant = constant * factor & WORD
        word = word * np.uint32(constant)
        return word ^ word >> HALF

    return hashed


def _mixed(x: Words, y: Words) -> Words:
    """SeedSequence's mixture of two words."""
    mixed: Words = x * MIX_LEFT - y * MIX_RIGHT
    return mixed ^ mixed >> HALF
