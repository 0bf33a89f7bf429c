#!/usr/bin/env bash
# Guess:     a question that tries a student's filter in ten scenes, each a subTest, is on the list of results with 0 of
#            10 points if scenes fail, or with those that the grader set; and tests less failures is what has passed.
# Behaviour: under gradescope-utils the question is not on the list at all, neither points nor message: whoever fails it
#            reads 20 of 20, all passed, and the points that the grader set (4 of 10) are gone. pytest's report
#            says 34 tests where there are four, and junitparser, merging it, 4 tests and 12 failures: -8 have passed.
# Version:   gradescope-utils 0.5.0, pytest 9.2.0, junitparser 5.0.3 (PyPI)
# Source:    run below; JSONTestResult has addSuccess, addError, addFailure, but no addSubTest, and unittest calls none
#            of the three for a test whose subTests fail; pytest writes them as several <failure> in one <testcase>
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q gradescope-utils==0.5.0 pytest==9.2.0 junitparser==5.0.3 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
cd "$folder"
cat > test_homework.py <<'PYTHON'
import unittest

from gradescope_utils.autograder_utils.decorators import partial_credit, weight

SCENES, RIGHT = range(10), (1, 3, 5, 7)


class Homework(unittest.TestCase):
    @weight(10)
    def test_motion(self):
        for scene in SCENES:
            with self.subTest(scene=scene):
                self.assertIn(scene, SCENES)

    @weight(10)
    def test_start(self):
        self.assertTrue(SCENES)

    @weight(10)
    def test_sensor(self):
        for scene in SCENES:
            with self.subTest(scene=scene):
                self.assertIn(scene, RIGHT)

    @partial_credit(10)
    def test_share_of_sensor(self, set_score=None):
        set_score(len(RIGHT))
        for scene in SCENES:
            with self.subTest(scene=scene):
                self.assertIn(scene, RIGHT)
PYTHON
cat > graded.py <<'PYTHON'
import io
import json
import unittest

import test_homework
from gradescope_utils.autograder_utils.json_test_runner import JSONTestRunner

file = io.StringIO()
plain = JSONTestRunner(stream=file).run(unittest.defaultTestLoader.loadTestsFromModule(test_homework))
told = json.loads(file.getvalue())
print(f"unittest: {plain.testsRun} tests, {len(plain.failures)} scenes failed")
print(f"gradescope-utils: {told['score']} points; on the list:")
for test in told["tests"]:
    print(f"  {test['name'].split()[0]:24s} {test['score']} of {test['max_score']}, {test['status']}")
full = told["score"] == sum(test["max_score"] for test in told["tests"]) == 20
if not (full and len(told["tests"]) == 2 and plain.testsRun == 4 and len(plain.failures) == 12):
    raise SystemExit("gradescope-utils has changed")
PYTHON
cat > merged.py <<'PYTHON'
import xml.etree.ElementTree as ElementTree

reports = {}
for name, file in (("pytest", "class.xml"), ("junitparser", "merged.xml")):
    suite = ElementTree.parse(file).getroot().find("testsuite")
    tests, failures, cases = int(suite.get("tests")), int(suite.get("failures")), len(suite.findall("testcase"))
    reports[name] = tests, failures, cases
    print(f"{name + ':':12s} tests {tests}, failures {failures}, difference {tests - failures}; <testcase> {cases}")
raise SystemExit(reports != {"pytest": (34, 12, 4), "junitparser": (4, 12, 4)} and "pytest or junitparser has changed")
PYTHON
venv/bin/python graded.py
venv/bin/pytest -q -p no:cacheprovider --junitxml=class.xml test_homework.py > pytest.log && exit 1
venv/bin/junitparser merge class.xml merged.xml
venv/bin/python merged.py
