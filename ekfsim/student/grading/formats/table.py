"""grades.csv: a row for each submission."""

import csv
from typing import TextIO

from ekfsim.files.keys.homework import HomeworkKeys
from ekfsim.printable import cell, in_a_line
from ekfsim.student.grading.scores import Grade, points


class Table:
    """Points of each part, their sum, the first wrong step, and the mistakes that were found."""

    def __init__(self, keys: HomeworkKeys, file: TextIO) -> None:
        self._out = csv.writer(file, lineterminator="\n")
        self._parts = [part.name for part in keys.parts]
        told = "first wrong step", "mistakes", "faults"
        self._write("submission", "points", "of", "judged", *self._parts, *told)

    def add(self, grade: Grade) -> None:
        """A row."""
        sums = [
            sum(score.cents for score in grade.scores if score.check.part == part)
            for part in self._parts
        ]
        numbers = map(points, (grade.cents, grade.most, grade.judged, *sums))
        listed = "; ".join(grade.mistakes), "; ".join(grade.faults)
        self._write(grade.submission, *numbers, grade.first_wrong, *listed)

    def _write(self, *row: str) -> None:
        self._out.writerow([cell(in_a_line(one)) for one in row])
