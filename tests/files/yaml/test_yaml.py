"""What YAML means here, and what of it is refused."""

import pytest

from ekfsim.errors import InputError
from ekfsim.files.source import as_written
from ekfsim.files.yaml.marked import NOTHING, scalar
from ekfsim.files.yaml.parsing import parse


def plain(text):
    root, mistakes = parse(text, "f.yaml")
    assert not mistakes
    return root.plain()


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("1e-3", 0.001),
        ("-.5", -0.5),
        ("5.", 5.0),
        ("+7", 7),
        ("010", 10),
        ("0o10", 8),
        ("0x1F", 31),
        ("1_000", "1_000"),
        ("1:30", "1:30"),
        ("no", "no"),
        ("off", "off"),
        ("yes", "yes"),
        ("y", "y"),
        ("true", True),
        ("False", False),
        ("2026-01-02", "2026-01-02"),
        ("2026-13-45", "2026-13-45"),
        ("=", "="),
        ("nan", "nan"),
        ("", NOTHING),
        ("~", NOTHING),
        ("null", NOTHING),
        (".inf", float("inf")),
        ("-.INF", -float("inf")),
        ("1e400", float("inf")),
    ],
)
def test_unquoted_text_means_what_yaml_1_2_says(written, meant):
    assert scalar(written) == meant
    assert type(scalar(written)) is type(meant)


def test_nan_is_a_number():
    assert scalar(".nan") != scalar(".nan")


def test_quoted_text_is_text():
    assert plain("a: '1'\nb: \"true\"\nc: |\n  5\n") == {"a": "1", "b": "true", "c": "5\n"}


def test_aliases_and_byte_order_marks_and_windows_line_ends_load(tmp_path):
    path = tmp_path / "f.yaml"
    path.write_bytes(b"\xef\xbb\xbfa: &x [1, 2]\r\nb: *x\r\n...\r\n")
    assert plain(as_written(path, "f.yaml")) == {"a": [1, 2], "b": [1, 2]}


def test_a_value_is_found_at_its_place():
    root, _ = parse("a:\n  - b: 1\n    'c d': x\n", "f.yaml")
    assert root.at(("a", 0, "c d")).mark == (3, 12)
    assert root.at(("a", 0)).keys == {"b": (2, 5), "c d": (3, 5)}
    assert root.at(("a", 1)) is None
    assert root.nearest(("a", 0, "e")).mark == (2, 5)


def told_of(path):
    """Every mistake in a file, as it is told."""
    try:
        _, mistakes = parse(as_written(path, "f.yaml"), "f.yaml")
    except InputError as error:
        mistakes = error.mistakes
    return list(map(str, mistakes))


REFUSED = {
    "empty": (b"", "1:1: the file is empty; see `ekfsim new` for one to start from"),
    "blank": (b" \n\n", "1:1: the file is empty; see `ekfsim new` for one to start from"),
    "comments": (b"# none\n", "1:1: the file is empty; see `ekfsim new` for one to start from"),
    "not UTF-8": (
        b"a: 1\nb: caf\xe9\n",
        "2:7: the byte 0xe9 is not UTF-8; save the file as UTF-8 in your editor",
    ),
    "UTF-16": (
        "a: 1".encode("utf-16"),
        "1:1: the file is UTF-16, not UTF-8; save it as UTF-8 in your editor",
    ),
    "NUL": (
        b"a: 1\r\nb: \0\n",
        "2:4: the character U+0000 (NUL) cannot stand in a text file; delete it",
    ),
    "bell": (b"a: \x07\n", "1:4: the character U+0007 cannot stand in a text file; delete it"),
    "inner mark": (
        "a: \ufeff\n".encode(),
        "1:4: the character U+FEFF cannot stand in a text file; delete it",
    ),
    "escaped": (
        b'a: "x\\0"\n',
        "1:4: a: the character U+0000 (NUL) cannot stand in text; delete it",
    ),
    "escaped colour": (
        b'- "\\e[31m"\n',
        "1:3: [0]: the character U+001B cannot stand in text; delete it",
    ),
    "tab": (b"a:\n\tb: 1\n", "2:1: a tab stands in the indentation; indent with spaces"),
    "tab before an item": (
        b"a:\n\t- b\n",
        "2:1: a tab stands in the indentation; indent with spaces",
    ),
    "tag": (
        b"a: !!python/object:os.system ls\n",
        "1:4: a: the tag '!!python/object:os.system' is not read; write the value without it",
    ),
    "tag of a list": (
        b"a: !set [1]\n",
        "1:4: a: the tag '!set' is not read; write the value without it",
    ),
    "tag of a key": (
        b"!!str a: 1\n",
        "1:1: the tag '!!str' is not read; write the value without it",
    ),
    "unknown tag": (
        b"a: !x!y 1\n",
        "1:4: tags ('!name!') are not read; write the value without it",
    ),
    "merge": (b"a: 1\n<<: {b: 1}\n", "2:1: merge keys ('<<') are not read; write the keys out"),
    "list as key": (
        b"[a, b]: 1\n",
        "1:1: a list or mapping stands where a key belongs; write a word, as in 'name: desk'",
    ),
    "repeated": (
        b"a: 1\nb: 2\na: 3\n",
        "3:1: the key 'a' is given twice, first on line 1; delete one",
    ),
    "second document": (
        b"a: 1\n---\nb: 2\n",
        "2:1: a second document begins here; keep one per file: delete from '---' on",
    ),
    "unknown alias": (
        b"a: *b\n",
        "1:4: a: '*b' refers to nothing; mark a value above it with '&b'",
    ),
    "alias of itself": (
        b"a: &b [1, *b]\n",
        "1:11: a[1]: '*b' stands inside the value it refers to; write the value out",
    ),
    "nameless alias": (
        b"a: *\n",
        "1:5: a '*' or '&' stands without a name; put text that begins with one in quotes",
    ),
    "colon": (
        b"say: look: here\n",
        "1:10: a ':' stands where no key can begin; "
        "put text that holds ': ' in quotes, and indent all keys of one mapping alike",
    ),
    "no colon": (
        b"a: 1\nb\nc: 2\n",
        "3:1: a key lacks its ': '; write 'key: value', with a space after the colon",
    ),
    "open list": (
        b"a: [1, 2\nb: 3\n",
        "2:2: the list '[' begun on line 1 is not closed before this; close each bracket, and "
        "separate values with ','",
    ),
    "open mapping": (
        b"a: {b: 1\nc: 2\n",
        "2:2: the mapping '{' begun on line 1 is not closed before this; "
        "close each bracket, and separate values with ','",
    ),
    "open quote": (b"a: 'b\n", "2:1: the quote opened on line 1 is never closed; close it"),
    "escape": (
        b'a: "\\q"\n',
        "1:5: this backslash begins no known escape; write '\\\\' for a backslash, or use single "
        "quotes",
    ),
    "at": (b"a: @b\n", "1:4: a value cannot begin with '@'; put it in quotes"),
    "percent": (b"a: %b\n", "1:4: a value cannot begin with '%'; put it in quotes"),
    "indentation": (
        b"a:\n  b: 1\n c: 2\n",
        "3:2: this belongs neither to the mapping begun on line 1 nor anywhere else; "
        "indent all keys of one mapping alike, and put text that begins with a quote or bracket "
        "wholly in quotes",
    ),
    "key in a list": (
        b"a:\n  - b\n  c: 1\n",
        "3:3: this belongs neither to the list begun on line 2 nor anywhere else; "
        "begin every item with '- ', all indented alike",
    ),
    "list on the line": (
        b"a: - b\n",
        "1:4: a list item '- ' cannot begin here; begin it on a line of its own",
    ),
    "bracket": (b"}\n", "1:1: a value is missing before this; write it"),
    "version": (
        b"%YAML 3.0\n---\na: 1\n",
        "1:1: the file asks for another version of YAML; delete the line '%YAML'",
    ),
    "depth": (
        b"[" * 200_000,
        "1:65: values are nested more than 64 levels deep; write fewer levels",
    ),
    "block depth": (
        b"- " * 200_000,
        "1:129: values are nested more than 64 levels deep; write fewer levels",
    ),
    "depth by aliases": (
        "a: &a " + "[" * 40 + "]" * 40 + "\nb: " + "[" * 40 + "*a" + "]" * 40,
        "1:4: values are nested more than 64 levels deep; write fewer levels",
    ),
    "explosion": (
        "a0: &a0 [1, 2]\n"
        + "".join(f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}'] * 10)}]\n" for i in range(7)),
        "6:5: the file holds more than 1 000 000 values, aliases written out; write fewer",
    ),
    "size": (
        b"#" * 10_000_001,
        "1:1: the file is larger than 10 MB; write a smaller one: no world needs that much",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(tmp_path, case):
    text, line = REFUSED[case]
    path = tmp_path / "f.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    assert told_of(path) == [f"f.yaml:{line}"]


def test_what_is_refused_leaves_the_rest_to_be_checked():
    root, mistakes = parse("a: !x 1\n<<: 2\na: 3\n[b]: 4\nc: *d\ne: 5\n---\nf: 6\n", "f.yaml")
    assert len(mistakes) == 6
    assert set(root.keys) == {"a", "c", "e"}
    assert root.at(("a",)).faulty


@pytest.mark.parametrize("sign", ["\x85", "\u2028", "\u2029"])
def test_lines_are_counted_as_editors_count_them(sign):
    root, mistakes = parse(
        f"name: a{sign}b\n# c{sign}d\ntext: 'e{sign}f'\nname: g\n\ue000: h\n", "f.yaml"
    )
    assert root.plain() == {"name": f"a{sign}b", "text": f"e{sign}f", "\ue000": "h"}
    assert [str(mistake.place) for mistake in mistakes] == ["f.yaml:4:1"]
    assert root.keys["\ue000"] == (5, 1)
    with pytest.raises(InputError) as refused:
        parse(f"name: a{sign}b\nlist: @\n", "f.yaml")
    assert str(refused.value).startswith("f.yaml:2:7: a value cannot begin with '@'")


def test_an_escaped_half_of_a_sign_is_told_with_the_way_out():
    with pytest.raises(InputError) as refused:
        parse('name: "\\ud83e\\udd16"\n', "f.yaml")
    assert "write the sign itself" in str(refused.value)
