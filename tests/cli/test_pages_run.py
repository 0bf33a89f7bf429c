"""Every command line of README.md and docs/ ends as its page says: it is run here, in the order of
its page, or by a test of the page's own, or the reason why not stands below."""

import re
import shlex
from pathlib import Path

import click
import pytest
from command_lines import COMMAND, PAGES, File, Line, named_in, read_through
from program import ekfsim
from small_logs import LOGS, MAP

from ekfsim import cli

OWN_TESTS = {  # which run the blocks of kind `sh` of a page
    "course.md": "test_course.py",
    "grading.md": "test_grading_page.py",
    "scenarios.md": "test_drive.py",
}
NOT_RUN = {  # these are understood, and no more
    "figures": "takes minutes: tests/figures/ draws what it draws",
    "run mower -q": "drives for 549 s: tests/cli/test_systems_e2e.py drives for less",
    "compare mower": "drives for 549 s, and again: tests/study/ compares shorter drives",
    "--through": "asks for another user: tests/student/sandbox/ begins processes by a command",
    "--show image": "asks for a terminal that draws pictures: tests/views/terminal/ plays one",
    "--watch": "asks for an editor: tests/views/terminal/test_watching.py saves files itself",
    "docker": "asks for a container",
    "tune ": "asks for a log of a minute: tests/cli/test_tune.py has its own",
    "run tuned.yaml": "asks for what that writes: tests/cli/test_tune.py runs it",
    "--cluster": "asks for a scheduler: tests/study/running/test_cluster.py has its own",
}
OPTIONS = {
    option
    for command in cli.ekfsim.commands.values()
    for parameter in command.params
    for option in parameter.opts
}
PLACEHOLDER = re.compile(r"\b[A-Z]{2,}\b|…|\|")
LOG = re.compile(r"(\w+)_log --log (?:DIR|FILE\.csv)")
QUICKER = {  # what is typed in addition, so that it is soon done
    "render": ["--every", "40"],
    "study": ["--runs", "2"],
    "compare": ["--runs", "2"],
    "gallery": ["--only", "square", "--cures", "2"],
    "hunt": ["--lists", "128", "--runs", "100", "--force"],
}
QUOTED = {  # what a page quotes of what a line prints, for which that is run in full
    "compare theta --seed 1 --runs 3000 --b filter.crossCovariances=dropped": [
        "4.87", "3.84 to 4.1",
    ],
    "compare diverge-11-short-returns --seed 1 --runs 3000 --b filter.rangeVariance=reading": [
        "67.4", "26.2",
    ],
    "compare diverge-01-wrong-wall --b guard=skip": ["37.7 percentage points (36.8 to 38.7)"],
    "study tour --sweep noise.rangeSigmaRatio=0.002,0.005,0.02,0.1,0.3 -o laser": [
        "NIS 19.1", "3.8 %", "play tour --seed 2 --run 7420 ",
    ],
}  # fmt: skip
KEYS = b"nnwq"
FAILS = {  # the lines that end with status 1, each as it is said to
    "play tour --filter filter.py": "eq. 6 is open",
    "diff tour --filter filter.py": "eq. 6 is open",
    "study diverge-01-wrong-wall --expect --guard skip": "not kept",
    "hunt furnished-room --for mine.py": "has the numbers of ekf in every list",
}
READERS = {  # what a reader has when the page comes to it: a file, or what a line writes
    "mine.yaml": "ekfsim new mine.yaml --from diverge-00-control",
    "mine.py": "ekfsim new mine.py --complete",
    "filter.py": "ekfsim new filter.py",
    "results.csv": "ekfsim run tour --log log --csv results.csv",
    "printed.txt": "ekfsim run tour --log log > printed.txt",
}


def is_usage(words: list[str]) -> bool:
    """Whether they tell how a command is used: by placeholders, or without what it has to have."""
    return PLACEHOLDER.search(" ".join(words)) is not None or any(
        len(words) == 1
        if isinstance(parameter, click.Argument)
        else not {*parameter.opts} & {*words}
        for parameter in cli.ekfsim.commands[words[0]].params
        if parameter.required
    )


def check_names(words: list[str]) -> None:
    """A command has the options that are told of it."""
    known = {name for parameter in cli.ekfsim.commands[words[0]].params for name in parameter.opts}
    assert {word for word in words if re.match(r"--?[a-z]", word)} <= known | {"--help"}, words


def typed(line: str) -> tuple[dict[str, str], bytes, list[str], str]:
    """The environment, the keys, the words after `ekfsim` and the file for the output of a line."""
    before, after = COMMAND.split(line, 1)
    keys = re.search(r"printf '?(\S+?)'? \|", before)
    command, _, file = after.partition(" > ")
    environment = dict(re.findall(r"\b([A-Z_]+)=(\S+)", before))
    return (
        environment,
        keys[1].encode() if keys else KEYS,
        shlex.split(command, comments=True),
        file,
    )


def run(line: str) -> None:
    """Run a line, after what its reader has done before, and look at how it ends."""
    environment, keys, words, file = typed(line)
    if words[0] == "new":
        Path(words[1]).unlink(missing_ok=True)  # of another line, for another try
    elif line not in READERS.values():
        for name in re.findall(r"[\w-]+\.\w+", line):
            if name in READERS and not Path(name).exists():
                run(READERS[name])
    command = " ".join(words)
    in_full = "--expect" in words or "--step" in words or command in QUOTED
    in_full |= "_log" in command or "-log.yaml" in command  # a recording has no runs
    quicker = [] if in_full else QUICKER.get(words[0], [])
    with pytest.MonkeyPatch.context() as patched:
        for name, value in environment.items():
            patched.setenv(name, value)
        ended = ekfsim(*words, *quicker, keys=keys)
    assert ended.status == (command in FAILS), (line, ended)
    told = [FAILS[command]] if command in FAILS else QUOTED.get(command, [])
    assert all(words in ended.out + ended.err for words in told), (line, ended)
    if file:
        Path(file).write_text(ended.out, encoding="utf-8")


def look_at(line: str) -> None:
    """Run a line, or see whether it is understood where that is all that can be done."""
    *_, words, _ = typed(line)
    if is_usage(words):
        check_names(words)
    elif any(word in line for word in NOT_RUN):
        cli.ekfsim.commands[words[0]].make_context(words[0], words[1:])
    else:
        run(line)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_command_line_of_a_page_is_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for format, files in LOGS.items():
        (tmp_path / "logs" / format).mkdir(parents=True)
        for name, text in files.items():
            (tmp_path / "logs" / format / name).write_text(text)
    for name, text in MAP.items():
        (tmp_path / name).write_text(text)
    found = read_through(page)
    lines = [each for each in found if isinstance(each, Line)]
    elsewhere = {line.text for line in lines if line.kind == "sh" and page.name in OWN_TESTS}
    for each in found:
        if isinstance(each, File):
            Path(each.name).write_text(each.text, encoding="utf-8")
        elif each.is_one and each.text not in elsewhere:
            look_at(LOG.sub(lambda log: f"{log[1]}_log --log logs/{log[1]}", each.text))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_no_command_line_of_a_page_is_passed_over(page):
    """Nor one that is told without the program's name, as `render --follow`, and no option."""
    found = read_through(page)
    assert sum(named_in(each.text) for each in found if isinstance(each, Line)) == named_in(
        page.read_text(encoding="utf-8")
    )
    for each in found:
        if isinstance(each, Line) and each.text.split()[0] in cli.ekfsim.commands:
            check_names(re.split(r"[\s,=]+", each.text))
        if isinstance(each, Line) and re.match(r"--[a-z]", each.text):
            assert re.split(r"[\s=]", each.text)[0] in OPTIONS


def test_every_exception_is_one():
    """And what is quoted is, on the page of its command."""
    told = {page: [each for each in read_through(page) if isinstance(each, Line)] for page in PAGES}
    for exception in [*NOT_RUN, *FAILS, *QUOTED]:
        pages = [
            page for page, lines in told.items() if any(exception in line.text for line in lines)
        ]
        assert pages, exception
        for quoted in QUOTED.get(exception, []):
            assert any(quoted in page.read_text(encoding="utf-8") for page in pages), quoted


@pytest.mark.parametrize(("page", "test"), OWN_TESTS.items())
def test_the_tests_of_pages_read_them(page, test):
    text = (Path(__file__).parent / test).read_text(encoding="utf-8")
    assert re.search(rf'"[\w/]*{page}"', text)
