"""Types of the values in a scene file: how they may be written, and what is allowed."""

from __future__ import annotations

import difflib
import reprlib
from collections.abc import Callable, Iterable
from typing import Annotated, Any, Literal, TypeVar

from pydantic import AllowInfNan, BaseModel, BeforeValidator, ConfigDict, Field, Strict, model_validator
from pydantic_core import PydanticCustomError

T = TypeVar("T")


class Table(BaseModel):
    """Base of all tables of a scene file: unknown keys are errors that list the known ones, the nearest first."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    @model_validator(mode="before")
    @classmethod
    def _only_known_keys(cls, data: Any) -> Any:
        unknown = [key for key in data if key not in cls.model_fields] if isinstance(data, dict) else []
        if unknown:
            problem = f"unknown key; allowed here: {listed(unknown[0], cls.model_fields)}"
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


def _coordinates(count: int) -> BeforeValidator:
    def check(value: Any) -> Any:
        if not isinstance(value, list | tuple) or len(value) != count:
            facts = {"value": reprlib.repr(value), "count": count}
            raise PydanticCustomError("coordinates", "is {value}; allowed: a list of {count} numbers", facts)
        return tuple(value)

    return BeforeValidator(check)


Real = Annotated[float, Strict(), AllowInfNan(False)]
Positive = Annotated[Real, Field(gt=0)]
Count = Annotated[int, Strict(), Field(ge=1)]
GaussPoints = Annotated[int, Strict(), Field(ge=1, le=64)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+$")]
FaceName = Annotated[str, Field(json_schema_extra={"pattern": r"^[A-Za-z0-9_-]+\.[uvw][01]$"})]
Axis = Literal["u", "v", "w"]

Point = Annotated[tuple[Real, Real, Real], _coordinates(3)]
PlanePoint = Annotated[tuple[Real, Real], _coordinates(2)]
#: One value a parametric direction; a single value stands for all three.
PerDirection = Annotated[tuple[T, T, T], BeforeValidator(_spread(3), json_schema_input_type=T | tuple[T, T, T])]
PerSurfaceDirection = Annotated[tuple[T, T], BeforeValidator(_spread(2), json_schema_input_type=T | tuple[T, T])]
