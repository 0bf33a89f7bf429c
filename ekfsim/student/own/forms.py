"""What of a module is a filter: two functions, or a class, with x and P or of the full protocol."""

import ast
import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import FunctionType, ModuleType
from typing import Any

from ekfsim.errors import UsageError
from ekfsim.student.own.home import shown

STEPS = {"predict": ("x", "P", "u", "motion"), "update": ("x", "P", "z", "sensor")}
OF_A_CLASS = {name: taken[2:] for name, taken in STEPS.items()}
RIGHT = (
    "write predict(x, P, u, motion) and update(x, P, z, sensor), "
    "or a class with predict(u, motion) and update(z, sensor)"
)


@dataclass(frozen=True)
class Functions:
    """Two plain functions that return x and P."""

    predict: Callable[..., Any]
    update: Callable[..., Any]


@dataclass(frozen=True)
class Stateful:
    """A class Mine(x, P), whose predict(u, motion) and update(z, sensor) change its x and P."""

    kind: type


@dataclass(frozen=True)
class Whole:
    """A class of the full protocol of filters (see filters/protocol.py)."""

    kind: type


Form = Functions | Stateful | Whole


def form_of(module: ModuleType, name: str, told: str) -> Form:
    """What is a filter in a module, by its name, "" where none is told. Raises UsageError.

    told : how the place is called
    """
    if name:
        return _named(module, name, told)
    found: list[Any] = [getattr(module, step, None) for step in STEPS]
    if all(map(_plain, found)):
        return _checked(Functions(*found), told)
    kinds = [kind for kind in vars(module).values() if _is_filter(kind, module)]
    if len(kinds) > 1:
        names = " or ".join(f"{told}:{kind.__name__}" for kind in kinds)
        raise UsageError(f"{told}: holds {len(kinds)} filters; name one of them: {names}")
    if kinds and not any(map(_plain, found)):
        return _checked(_of_class(kinds[0]), told)
    near = [name for name in vars(module) if _plain(getattr(module, name)) and _named_nearly(name)]
    missing = " and no ".join(
        f"{step}({', '.join(taken)})"
        for (step, taken), one in zip(STEPS.items(), found, strict=True)
        if not _plain(one)
    )
    has = f"; it has {', '.join(near)}" if near else ""
    raise UsageError(f"{told}: has no {missing}{has}; {RIGHT}")


def told(form: Form) -> str:
    """What was found, for a person: "predict in line 3, update in line 7"."""
    if isinstance(form, Functions):
        return f"{_in_line('predict', form.predict)}, {_in_line('update', form.update)}"
    what = "of the full protocol" if isinstance(form, Whole) else "with x and P"
    return f"the class {form.kind.__name__}, {what}"


def _in_line(step: str, function: Any) -> str:
    _, _, line = where(function).rpartition(":")
    code = getattr(function, "__code__", None)
    left = " (still open)" if "NotImplementedError" in getattr(code, "co_names", ()) else ""
    return f"{step} in line {line}{left}" if line else f"{step}{left}"


def _named(module: ModuleType, name: str, told: str) -> Form:
    """The filter of that name. Raises UsageError where there is none, or where it is none."""
    found: Any = module
    for part in name.split("."):
        found = getattr(found, part, None)
    if found is None:
        names = [kind.__name__ for kind in vars(module).values() if _is_filter(kind, module)]
        right = f"it has {', '.join(names)}" if names else "it has no class that is a filter"
        raise UsageError(f"{told}: there is no '{name}' in it; {right}")
    if isinstance(found, type):
        missing = [step for step in STEPS if not callable(getattr(found, step, None))]
        if missing:
            raise UsageError(f"{told}: the class has no {' and no '.join(missing)}; {RIGHT}")
        return _checked(_of_class(found), told)
    steps: list[Any] = [getattr(found, step, None) for step in STEPS]
    if all(map(callable, steps)) and not isinstance(found, FunctionType):
        return _checked(Functions(*steps), told)
    raise UsageError(f"{told}: is no class; {RIGHT}")


def _of_class(kind: type) -> Form:
    return Whole(kind) if callable(getattr(kind, "begin", None)) else Stateful(kind)


def _named_nearly(name: str) -> bool:
    """Whether a function is one of the two, but for its name: ekf_predict, Update."""
    return name not in STEPS and any(step in name.lower() for step in STEPS)


def _plain(value: Any) -> bool:
    """Whether it may be one of the two functions."""
    return callable(value) and not isinstance(value, type)


def _is_filter(kind: Any, module: ModuleType) -> bool:
    """Whether it is a class with both steps that stands in the module itself."""
    return (
        isinstance(kind, type)
        and kind.__module__ == module.__name__
        and not inspect.isabstract(kind)
        and all(callable(getattr(kind, step, None)) for step in STEPS)
    )


def _checked(form: Form, told: str) -> Form:
    """The same form. Raises UsageError where it cannot be called as it must be."""
    if isinstance(form, Whole):
        return form
    needed, of = (STEPS, "") if isinstance(form, Functions) else (OF_A_CLASS, "self, ")
    for step, taken in needed.items():
        function = getattr(form if isinstance(form, Functions) else form.kind, step)
        if not _takes(function, (*taken, "self") if of else taken):
            place = where(function)
            right = f"write {step}({of}{', '.join(taken)})"
            wrong = f"{step}{_signature(function)} does not take what it is given"
            raise UsageError(f"{place or told}: {wrong}; {right}")
        names = [name for name in _names(function) if name in taken]
        if len(names) == len(taken) and tuple(names) != taken:
            wrong = f"{step} takes {', '.join(names)}, but is given {', '.join(taken)}"
            raise UsageError(f"{where(function) or told}: {wrong}; write them in this order")
    if isinstance(form, Stateful) and not _takes(form.kind, ("x", "P")):
        place = where(form.kind.__init__)  # type: ignore[misc]
        wrong = f"{form.kind.__name__}{_signature(form.kind)} is not begun with x and P"
        raise UsageError(f"{place or told}: {wrong}; write __init__(self, x, P)")
    return form


def _takes(function: Callable[..., Any], taken: tuple[str, ...]) -> bool:
    """Whether it can be called with so many arguments, as far as can be told."""
    try:
        inspect.signature(function).bind(*taken)
    except TypeError:
        return False
    except ValueError:  # no signature is known
        return True
    return True


def _names(function: Callable[..., Any]) -> tuple[str, ...]:
    """What it takes, by name and in order; none where that is not known."""
    try:
        return tuple(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        return ()


def _signature(function: Callable[..., Any]) -> str:
    try:
        return str(inspect.signature(function))
    except (TypeError, ValueError):
        return ""


def where(function: Any, source: bytes | None = None) -> str:
    """file:line of a function: of its only return, else of its head; "" where none is known.

    source : of the file that it stands in, where its return is wanted
    """
    code = getattr(inspect.unwrap(getattr(function, "__func__", function)), "__code__", None)
    if code is None:
        return ""
    line: int = code.co_firstlineno
    if source is not None:
        returns = list(_returns(source, line))
        line = returns[0] if len(returns) == 1 else line
    return f"{shown(code.co_filename)}:{line}"


def _returns(source: bytes, line: int) -> Iterator[int]:
    """The lines at which the function that begins on a line returns something."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef) and line in (
            node.lineno,
            *(decorator.lineno for decorator in node.decorator_list),
        ):
            waiting: list[ast.AST] = list(node.body)
            while waiting:
                part = waiting.pop()
                if isinstance(part, ast.Return):
                    yield part.lineno
                if not isinstance(part, ast.FunctionDef | ast.Lambda | ast.ClassDef):
                    waiting.extend(ast.iter_child_nodes(part))
