"""Types of the values in a scene file: how they may be written, and what is allowed."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Iterable
from dataclasses import fields
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, Strict, model_validator
from pydantic_core import PydanticCustomError

from isomortar.model.values import TABLE, Real, coordinates

T = TypeVar("T")

#: Tables and lists of the whole file. In TOML what follows a [table] belongs to it, and so did they where one of these is not known.
OF_THE_FILE = ("materials", "bodies", "glue", "contacts", "symmetry", "supports", "loads", "stages", "solver", "record")


class Table(BaseModel):
    """Base of all tables of a scene file: unknown keys are errors that list the known ones, the nearest first."""

    # What validates a table is made when it is first asked: of those within another that is never, as the outer one's does it all.
    model_config = ConfigDict(**TABLE, frozen=True, defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _only_known_keys(cls, data: Any) -> Any:
        return _only(cls.model_fields, data)


def entity(kind: type) -> BeforeValidator:
    """A dataclass of the problem as a table: unknown keys are errors as those of a `Table` are."""
    return BeforeValidator(lambda data: _only([field.name for field in fields(kind)], data))


def _only(known: Collection[str], data: Any) -> Any:
    unknown = [key for key in data if key not in known] if isinstance(data, dict) else []
    if unknown:
        stray = f"; {unknown[0]} is a key of the whole file: put it above the first [table]" if unknown[0] in OF_THE_FILE else ""
        problem = f"unknown key; allowed here: {listed(unknown[0], known)}{stray}"
        raise PydanticCustomError("unknown_key", "{problem}", {"problem": problem, "key": unknown[0]})
    return data


def listed(name: str, allowed: Iterable[str]) -> str:
    """The allowed names as one text, those nearest to `name` first."""
    names = list(allowed)
    near = difflib.get_close_matches(name, names, n=3)
    return ", ".join(near + [n for n in names if n not in near]) or "(there are none)"


def _spread(count: int) -> Callable[[Any], Any]:
    """One value for all directions, or one for each."""

    def spread(value: Any) -> Any:
        values = tuple(value) if isinstance(value, list | tuple) else (value,) * count
        if len(values) != count:
            facts = {"given": len(values), "count": count}
            raise PydanticCustomError("directions", "has {given} values; allowed: one for all directions, or {count}", facts)
        return values

    return spread


def _no_equal(value: Any) -> Any:
    """A value as it is: a truth value or a number with a point is equal to the one that is allowed, and none."""
    if isinstance(value, bool | float):
        raise PydanticCustomError("version", "is {value}; allowed: 1", {"value": repr(value).lower()})
    return value


#: Of the file's format, the only one there is.
Version = Annotated[Literal[1], BeforeValidator(_no_equal, json_schema_input_type=Literal[1])]
Grading = Annotated[Real, Field(ge=1e-3, le=1e3)]
GaussPoints = Annotated[int, Strict(), Field(ge=1, le=64)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+$")]
#: Of a scene, whose results are files of that name: letters of any script, too.
SceneName = Annotated[str, Field(pattern=r"^([A-Za-z0-9_-]|[^\u0000-\u00A0])+$")]
FaceName = Annotated[str, Field(json_schema_extra={"pattern": r"^[A-Za-z0-9_-]+\.[uvw][01]$"})]
EdgeName = Annotated[str, Field(json_schema_extra={"pattern": r"^[A-Za-z0-9_-]+(\.[uvw][01]){2}$"})]
CornerName = Annotated[str, Field(json_schema_extra={"pattern": r"^[A-Za-z0-9_-]+(\.[uvw][01]){3}$"})]
#: A side of a contact: a face, or several.
Side = Annotated[
    tuple[FaceName, ...],
    Field(min_length=1),
    BeforeValidator(lambda value: (value,) if isinstance(value, str) else value, json_schema_input_type=FaceName | list[FaceName]),
]

Interval = Annotated[tuple[Real, Real], coordinates(2)]
PlanePoint = Annotated[tuple[Real, Real], coordinates(2)]
#: One value a parametric direction; a single value stands for all three.
PerDirection = Annotated[tuple[T, T, T], BeforeValidator(_spread(3), json_schema_input_type=T | tuple[T, T, T])]
PerSurfaceDirection = Annotated[tuple[T, T], BeforeValidator(_spread(2), json_schema_input_type=T | tuple[T, T])]
