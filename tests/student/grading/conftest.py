import pytest

from ekfsim.files.homework import read_homework
from ekfsim.student.grading.bench import Bench
from ekfsim.student.grading.scores import Scored, checks_of


@pytest.fixture
def asked(tmp_path):
    """A homework of parts that are told in a line each, and a score that is not run for each of its
    tests."""

    def read(*parts, points=10, head=""):
        path = tmp_path / "homework.yaml"
        lines = [
            f"  - {{name: part {n}, points: {points}, {part}}}" for n, part in enumerate(parts, 1)
        ]
        total = f"homework: EKF\ntotal: {points * len(parts)}\n{head}\nparts:\n"
        path.write_text(total + "\n".join(lines) + "\n")
        homework = read_homework(path)
        return homework, Bench(homework), [Scored(check) for check in checks_of(homework.keys)]

    return read
