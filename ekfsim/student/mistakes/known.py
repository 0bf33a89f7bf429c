"""The table of the known mistakes: moves before readings, the most general last."""

from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.beams import OF_BEAMS
from ekfsim.student.mistakes.table.beliefs import OF_BELIEFS
from ekfsim.student.mistakes.table.gains import OF_GAINS
from ekfsim.student.mistakes.table.moves import OF_MOVES
from ekfsim.student.mistakes.table.noise import OF_NOISE
from ekfsim.student.mistakes.table.numbers import OF_NUMBERS
from ekfsim.student.mistakes.table.readings import OF_READINGS
from ekfsim.student.mistakes.table.slopes import OF_SLOPES

KNOWN: tuple[Mistake, ...] = (
    *OF_MOVES,
    *OF_SLOPES,
    *OF_NOISE,
    *OF_READINGS,
    *OF_BEAMS,
    *OF_GAINS,
    *OF_BELIEFS,
    *OF_NUMBERS,
)
BY_NAME: dict[str, Mistake] = {mistake.name: mistake for mistake in KNOWN}
