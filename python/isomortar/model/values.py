"""Values that a person gives, in a scene file or in Python: which are allowed."""

from __future__ import annotations

import reprlib
from typing import Annotated, Any

from pydantic import AllowInfNan, BeforeValidator, ConfigDict, Field, Strict
from pydantic_core import PydanticCustomError

#: Of a dataclass that is a table of a scene file as well: it has no other keys.
TABLE = ConfigDict(extra="forbid")

Real = Annotated[float, Strict(), AllowInfNan(False)]
Positive = Annotated[Real, Field(gt=0)]
Count = Annotated[int, Strict(), Field(ge=1)]


def coordinates(count: int) -> BeforeValidator:
    """A list of so many numbers, as a tuple."""

    def check(value: Any) -> Any:
        if not isinstance(value, list | tuple) or len(value) != count:
            facts = {"value": reprlib.repr(value), "count": count}
            raise PydanticCustomError("coordinates", "is {value}; allowed: a list of {count} numbers", facts)
        return tuple(value)

    return BeforeValidator(check)


Point = Annotated[tuple[Real, Real, Real], coordinates(3)]
