"""The table of the known mistakes, the most common of a room first."""

from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.of_beams import OF_BEAMS
from ekfsim.student.mistakes.of_gains import OF_GAINS
from ekfsim.student.mistakes.of_moves import OF_MOVES
from ekfsim.student.mistakes.of_noise import OF_NOISE
from ekfsim.student.mistakes.of_readings import OF_READINGS
from ekfsim.student.mistakes.of_slopes import OF_SLOPES

KNOWN: tuple[Mistake, ...] = (
    *OF_MOVES,
    *OF_SLOPES,
    *OF_NOISE,
    *OF_READINGS,
    *OF_BEAMS,
    *OF_GAINS,
)
BY_NAME: dict[str, Mistake] = {mistake.name: mistake for mistake in KNOWN}
