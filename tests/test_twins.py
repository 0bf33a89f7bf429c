from pathlib import Path

import pytest

from ekfsim import kept, twins
from ekfsim.fast import table
from ekfsim.fast.table import Twin


def quick(x):
    """A twin that declines what is negative."""
    return None if x < 0 else ("quick", x)


@pytest.fixture
def named(monkeypatch):
    """A function of the text with one twin for floats, and one more that is compiled."""

    @twins.twinned
    def text(x):
        return ("text", x)

    of = f"{__name__}:{text.text.__qualname__}"
    monkeypatch.setattr(table, "TWINS", (
        Twin(of, f"{__name__}:compiled", "any", compiled=True),
        Twin(of, f"{__name__}:quick", "numbers that are not negative", given="float"),
    ))  # fmt: skip
    return text


def compiled(x):
    return ("compiled", x)


def test_a_twin_stands_in_where_it_suits(named):
    assert named(1.0) == ("quick", 1.0)
    assert named(-1.0) == ("text", -1.0)  # it declines
    assert named(1) == ("text", 1)  # another class
    with twins.taking("plain"):
        assert named(1.0) == ("text", 1.0)
    assert named(1.0) == ("quick", 1.0)


@pytest.mark.skipif(not twins.compiles(), reason="the extra `fast` is not installed")
def test_what_is_compiled_stands_in_only_where_it_is_asked_for(named):
    with twins.taking("compiled"):
        assert named(1.0) == ("compiled", 1.0)
    assert named(1.0) == ("quick", 1.0)


def test_ways_that_are_none_are_refused(monkeypatch):
    with pytest.raises(ValueError, match="no way"):
        twins.take("fast")
    monkeypatch.setattr(twins, "compiles", lambda: False)
    with pytest.raises(ModuleNotFoundError, match="extra `fast`"):
        twins.take("compiled")
    assert twins.taken() == "quick"


@pytest.mark.skipif(not twins.compiles(), reason="the extra `fast` is not installed")
def test_where_no_folder_can_be_written_a_function_is_compiled_anew(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(kept, "PACKAGE", tmp_path / "file")
    monkeypatch.setattr(kept, "USERS", tmp_path / "file")
    kept.folder_for.cache_clear()
    assert twins.compiled(lambda x: x + 1)(1) == 2
    kept.folder_for.cache_clear()


@pytest.mark.skipif(not twins.compiles(), reason="the extra `fast` is not installed")
def test_what_is_compiled_is_kept_by_the_state_of_all_files_that_are_compiled():
    from numba import config

    from ekfsim.fast.compiled.carlson import carlson

    before = config.CACHE_DIR
    assert Path(carlson.stats.cache_path).parent.name == f"ekfsim-{kept.state_of(kept.PACKAGE)}"
    assert before == config.CACHE_DIR


def test_the_state_is_another_where_any_file_that_is_compiled_differs(tmp_path):
    for name in ("fast/compiled/steps.py", "fast/compiled/carlson.py", "fast/table.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("a = 1\n")
    first = kept.state_of(tmp_path)
    (tmp_path / "fast/table.py").write_text("a = 2\n")
    assert kept.state_of(tmp_path) == first
    (tmp_path / "fast/compiled/carlson.py").write_text("a = 2\n")
    assert kept.state_of(tmp_path) != first
