"""The names that programs give to the numbers of a belief → which number each column holds."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

from ekfsim.errors import Mistake, Place
from ekfsim.files.yaml.telling import quoted

INDEX = ("index", "step", "k", "i", "n", "nr", "no", "row")
HEADING = ("theta", "th", "t", "heading", "phi", "yaw", "orientation", "angle", "θ", "φ")
AXES = (("x",), ("y",), HEADING)
COVARIANCE = ("p", "cov", "covariance", "sigma", "s", "c", "var", "px")
UNITS = {"deg": "degrees", "degree": "degrees", "degrees": "degrees", "°": "degrees",
         "rad": "radians", "radian": "radians", "radians": "radians"}  # fmt: skip
OF_THE_MEAN = re.compile(r"^(est(imated?)?|mu|mean)|(hat|est(imated?)?|mean)$")
UNIT = r"deg\w*|°|rad\w*|m|m\^?2|m²|rad\^?2|rad²|m\s?[*·]?\s?rad|-"
LIKE = "index,x,y,theta,P_xx,P_xy,P_xtheta,P_yy,P_ytheta,P_thetatheta"

Pair = tuple[int, int]
PAIRS: tuple[Pair, ...] = tuple((i, j) for i in range(3) for j in range(3))


@dataclass(frozen=True)
class Columns:
    """Where each number stands in a row, from 0."""

    index: int | None  # None where rows are told by their order
    x: tuple[int, int, int]
    P: dict[Pair, int]  # all nine, where only six are given each of three for two
    unit: str  # of the heading, "" where no name tells it


def columns_of(names: Sequence[str], place: Place) -> Columns | list[Mistake]:
    """What the columns of a header are, or what is missing."""
    plain = [_plain(name) for name in names]
    units = [UNITS.get(_unit(name), "") for name in names]
    index = _first(plain, INDEX)
    bare = [OF_THE_MEAN.sub("", name) for name in plain]  # x_hat, mu_x
    mean = [_first([*plain, *bare], axis) for axis in AXES]
    start = 0 if any(name in _pairs("00", 0) for name in plain) else 1
    pairs = dict[Pair, int]()
    for pair in PAIRS:
        at = _first(plain, tuple(_names_of(pair, start)))
        if at is not None:
            pairs[pair] = at
    whole = {(i, j): pairs.get((i, j), pairs.get((j, i), -1)) for i, j in PAIRS}
    missing = [name for name, at in zip(("x", "y", "theta"), mean, strict=True) if at is None]
    missing += [f"P_{_axis(i)}{_axis(j)}" for (i, j), at in whole.items() if at < 0 and i <= j]
    if missing:
        found = ", ".join(map(quoted, names))
        right = f"name the columns e.g. {LIKE}; found {found}"
        wrong = f"no column is named {missing[0]}"
        wrong += f", nor {', '.join(missing[1:])}" if missing[1:] else ""
        return [Mistake(place, "", wrong, right)]
    x, y, theta = (at % len(plain) for at in mean if at is not None)
    for at in sorted({x, y, theta, *whole.values()}):
        if plain.count(plain[at]) > 1:
            wrong = f"{plain.count(plain[at])} columns are named {quoted(names[at])}"
            return [Mistake(place, "", wrong, "keep the one that holds the number")]
    return Columns(index, (x, y, theta), whole, units[theta])


def _first(plain: Sequence[str], known: Sequence[str]) -> int | None:
    """The column with the first of some names that there is."""
    return next((plain.index(name) for name in known if name in plain), None)


def _axis(i: int) -> str:
    return ("x", "y", "theta")[i]


def _plain(name: str) -> str:
    """A name without case, unit, power and whatever stands between its letters.

    >>> _plain("P_x,theta"), _plain("sigma_xy^2 [m^2]"), _plain("theta (deg)"), _plain("P[0][1]")
    ('pxtheta', 'varxy', 'theta', 'p01')
    """
    name = name.strip().strip("\"'").lower().replace("σ", "sigma")
    name = re.sub(rf"[(\[]\s*({UNIT})\s*[)\]]$|[_ ]({UNIT})$", "", name)
    name = re.sub(r"^sigma_?(\w+)(\^2|²)\s*$", r"var\1", name)  # σ_x² is no σ_x
    return re.sub(r"[^\wθφ]|_", "", re.sub(r"\^2|²", "", name))


def _unit(name: str) -> str:
    """The last word of a name."""
    words = re.findall(r"[a-z°]+", name.lower())
    return words[-1] if words else ""


def _names_of(pair: Pair, start: int) -> Iterator[str]:
    """What an entry of P may be called: by its axes, by its row and column, as a variance."""
    i, j = pair
    for a, b in product(AXES[i], AXES[j]):
        yield from _pairs(f"{a}{b}", i == j and a == b and len(a))
    yield from _pairs(f"{i + start}{j + start}", 0)


def _pairs(entry: str, variance: int) -> Iterator[str]:
    for symbol in COVARIANCE:
        yield f"{symbol}{entry}"
    if variance:  # var_x, sigma_x2
        yield f"var{entry[:variance]}"
        yield f"sigma{entry[:variance]}2"
