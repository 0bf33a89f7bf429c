"""What a YAML parser says, in words that help."""

import re

import yaml

from ekfsim.errors import Mistake, Place

SPACES = "indent with spaces"
CLOSE = "close each bracket, and separate values with ','"

# What the parser says of a text → what is wrong, and what would be right.
WORDS = {
    "found a tab": ("a tab stands in the indentation", SPACES),
    "mapping values are not allowed": (
        "a ':' stands where no key can begin",
        "put text that holds ': ' in quotes, and indent all keys of one mapping alike",
    ),
    "could not find expected ':'": (
        "a key lacks its ': '",
        "write 'key: value', with a space after the colon",
    ),
    "block sequence entries are not allowed": (
        "a list item '- ' cannot begin here",
        "begin it on a line of its own",
    ),
    "expected ',' or ']'": ("the list '[' begun on line {begun} is not closed before this", CLOSE),
    "expected ',' or '}'": (
        "the mapping '{{' begun on line {begun} is not closed before this",
        CLOSE,
    ),
    "did not find expected key": (
        "this belongs neither to the mapping begun on line {begun} nor anywhere else",
        "indent all keys of one mapping alike, and put text that begins with a quote or bracket "
        "wholly in quotes",
    ),
    "expected '-' indicator": (
        "this belongs neither to the list begun on line {begun} nor anywhere else",
        "begin every item with '- ', all indented alike",
    ),
    "<block end>": (
        "this belongs neither to what began on line {begun} nor anywhere else",
        "indent all keys of one mapping, and all items of one list, alike",
    ),
    "found unexpected end of stream": (
        "the quote opened on line {begun} is never closed",
        "close it",
    ),
    "found unexpected document indicator": (
        "the quote opened on line {begun} is not closed before this",
        "close it",
    ),
    "unknown escape character": (
        "this backslash begins no known escape",
        "write '\\\\' for a backslash, or use single quotes",
    ),
    "invalid Unicode character escape": (
        "this escape is no sign of its own",
        "write the sign itself, or one escape for it, as in '\\U0001F916'",
    ),
    "<document start>": ("this stands behind the end of the document", "indent it, or delete it"),
    "undefined tag handle": ("tags ('!name!') are not read", "write the value without it"),
    "incompatible YAML document": (
        "the file asks for another version of YAML",
        "delete the line '%YAML'",
    ),
    "expected alphabetic or numeric character": (
        "a '*' or '&' stands without a name",
        "put text that begins with one in quotes",
    ),
    "node content": ("a value is missing before this", "write it"),
}


def syntax_mistake(error: yaml.YAMLError, text: str, file: str) -> Mistake:
    """Why a text is not YAML."""
    if not isinstance(error, yaml.MarkedYAMLError):
        return Mistake(
            Place(file), "", "the file is not YAML", "see `ekfsim new` for one to start from"
        )
    mark = error.problem_mark or error.context_mark
    begun = error.context_mark.line + 1 if error.context_mark else 1
    line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
    wrong, right = words_for(error.problem or "", character_at(text, line, column))
    return Mistake(Place(file, line, column), "", wrong.format(begun=begun), right)


def words_for(problem: str, char: str) -> tuple[str, str]:
    """What is wrong and what would be right; `char` is the character that the parser stopped at."""
    if "cannot start any token" in problem:
        if char == "\t":
            return WORDS["found a tab"]
        shown = char.replace("{", "{{").replace("}", "}}")
        return f"a value cannot begin with '{shown}'", "put it in quotes"
    for part, words in WORDS.items():
        if part in problem:
            return words
    shown = problem.replace("{", "{{").replace("}", "}}")
    return f"this is not YAML ({shown})", "check quotes, brackets and indentation"


def character_at(text: str, line: int, column: int) -> str:
    """The character at a place, "" behind the end of its line."""
    lines = re.split("\r\n|\r|\n", text)
    return lines[line - 1][column - 1 : column] if line <= len(lines) else ""
