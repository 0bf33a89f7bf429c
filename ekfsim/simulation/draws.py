"""The random numbers of runs: each a function of the seed, the number of the draw and the run
alone.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.seeds import MOST_SEED, REPEATS
from ekfsim.twins import twinned
from ekfsim.world import World

BLOCK = 1024  # runs that share a generator
# keys of the generators of particle filters and of streams, apart from those of the draws
PARTICLES, STREAMS, STARTS, PLACES = 1, 2, 3, 4


class Draws:
    """The random numbers of some runs: a function of (seed, index, run) alone.

    Draw i of the runs 1024·b … 1024·b + 1023 comes from

        Generator(PCG64(SeedSequence([seed, i, b])))

    normals of shape (1024, 4) first, then uniforms of shape (1024, 2). So another ratio, filter or
    gate changes no draw, and any run of a study can be played alone.
    """

    def __init__(self, seed: int, runs: Integers) -> None:
        _verify(seed, runs)
        self._seed = seed
        self._runs = runs
        self._neighbours = _neighbours(runs)

    def normals(self, i: int) -> Sequence[Array]:
        """The four standard normals of draw i : (…) each"""
        return self._draw(i, uniforms=False)[0]

    def normals_and_uniforms(self, i: int) -> tuple[Sequence[Array], Sequence[Array]]:
        """The four standard normals and the two uniforms in [0, 1) of draw i : (…) each"""
        return self._draw(i, uniforms=True)

    def stream(self, *key: int) -> "Stream":
        """Normals of these runs that come one after another."""
        return Stream(self._seed, self._runs, key)

    def _draw(self, i: int, uniforms: bool) -> tuple[Sequence[Array], Sequence[Array]]:
        if self._runs.ndim == 0:
            return draw(self._seed, i, int(self._runs), uniforms)
        if self._neighbours is not None:
            return self._draw_neighbours(i, *self._neighbours, uniforms)
        normals_of, uniforms_of = np.empty((4, *self._runs.shape)), np.empty((2, *self._runs.shape))
        blocks = self._runs // BLOCK
        for b in np.unique(blocks).tolist():
            here = blocks == b
            rows = self._runs[here] % BLOCK
            generator = _generator(self._seed, i, b)
            normals_of[:, here] = generator.standard_normal((BLOCK, 4))[rows].T
            if uniforms:
                uniforms_of[:, here] = generator.random((BLOCK, 2))[rows].T
        return tuple(normals_of), tuple(uniforms_of)

    def _draw_neighbours(
        self, i: int, b: int, rows: slice, uniforms: bool
    ) -> tuple[Sequence[Array], Sequence[Array]]:
        """The same for runs that follow one another in one block, as those of a study do."""
        generator = _generator(self._seed, i, b)
        normals = generator.standard_normal((BLOCK if uniforms else rows.stop, 4))[rows]
        return tuple(normals.T), tuple(generator.random((BLOCK, 2))[rows].T) if uniforms else ()


@twinned
def draw(seed: int, i: int, run: int, uniforms: bool) -> tuple[Sequence[Any], Sequence[Any]]:
    """Draw i of one run, in plain floats: of the normals no more than is needed, for the uniforms
    stand behind all of them.
    """
    b, row = divmod(run, BLOCK)
    generator = _generator(seed, i, b)
    normals = generator.standard_normal((BLOCK if uniforms else row + 1, 4))[row].tolist()
    return normals, generator.random((BLOCK, 2))[row].tolist() if uniforms else ()


def _generator(seed: int, i: int, b: int) -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, i, b])))


class Stream:
    """Standard normals of some runs, taken one after another: a function of (seed, run, key) alone.

    Those of run k come from Generator(PCG64(SeedSequence([seed, k], spawn_key=(2, *key)))) in the
    order of time. However many are taken at once, they are the same: a driven robot's noises are
    drawn for many ticks together.
    """

    def __init__(self, seed: int, runs: Integers, key: tuple[int, ...]) -> None:
        self._axes = runs.shape
        self._generators = [
            np.random.Generator(
                np.random.PCG64(np.random.SeedSequence([seed, int(run)], spawn_key=(STREAMS, *key)))
            )
            for run in np.atleast_1d(runs)
        ]

    def normals(self, rows: int, columns: int) -> Array:
        """The next ones : (rows, …, columns)"""
        drawn = np.empty((len(self._generators), rows, columns))
        for generator, of_run in zip(self._generators, drawn, strict=True):
            generator.standard_normal(out=of_run)
        return drawn.swapaxes(0, 1).reshape(rows, *self._axes, columns)

    def uniforms(self, rows: int) -> Array:
        """In place of normals, the next numbers in [0, 1) : (rows, …)"""
        drawn = np.stack([generator.random(rows) for generator in self._generators], axis=1)
        return drawn.reshape(rows, *self._axes)


def _verify(seed: int, runs: Integers) -> None:
    """Raises UsageError for a seed that would repeat another's draws, and for a seed or runs that
    have none.
    """
    if not 0 <= seed <= MOST_SEED:
        wrong = "negative" if seed < 0 else f"too large: {REPEATS}"
        raise UsageError(f"seed {seed} is {wrong}; choose one from 0 to {MOST_SEED}")
    if np.any(runs < 0):
        raise UsageError(f"run {np.min(runs)} is negative; runs are numbered from 0")


def _neighbours(runs: Integers) -> tuple[int, slice] | None:
    """The block that holds all of these runs, and their rows in it, where they follow one another;
    otherwise None.
    """
    if runs.ndim != 1 or not runs.size:
        return None
    b, row = divmod(int(runs[0]), BLOCK)
    end = row + len(runs)
    return (b, slice(row, end)) if end <= BLOCK and (np.diff(runs) == 1).all() else None


def true_start(world: World, draws: Draws) -> Array:
    """Where each run truly starts : (…, 3), drawn from N(start, start_sigma²)"""
    pose: Array = world.start + world.start_sigma * np.stack(draws.normals(0)[:3], axis=-1)
    pose[..., 2] = wrap(pose[..., 2])
    return pose


def particle_generators(
    seed: int, runs: Integers, key: int = PARTICLES
) -> Sequence[np.random.Generator]:
    """A generator for the particles of each run, alike whether it is run alone or beside others; by
    the key STARTS one for the first of them, where no start is known.
    """
    _verify(seed, runs)
    keys = (
        np.random.SeedSequence([seed, int(run)], spawn_key=(key,)) for run in np.atleast_1d(runs)
    )
    return [np.random.Generator(np.random.PCG64(key)) for key in keys]
