"""What every group of scenario keys is made of."""

from collections.abc import Callable, Iterable
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

Finite = Annotated[float, Field(allow_inf_nan=False)]


class Group(BaseModel):
    """A group of keys: immutable, strictly typed, closed to unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, validate_default=True)


def as_tuple(value: Any) -> Any:
    """A list as the tuple that an immutable group holds; anything else as it is."""
    return tuple(value) if isinstance(value, list) else value


class OneOf:
    """One of the names that a registry has when a value is checked: other packages may bring more of them.

    Args:
        default: one that is always there; it is accepted without a look at the others.
        names: gives them all; asked at each check of another name, so that nothing is imported before.
    """

    def __init__(self, default: str, names: Callable[[], Iterable[str]]) -> None:
        self._default, self._names = default, names

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """Check as a literal would, with its message."""
        return core_schema.no_info_after_validator_function(self._check, core_schema.str_schema(strict=True))

    def __get_pydantic_json_schema__(self, schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Describe as a literal would."""
        return {"enum": list(self._names()), "type": "string"}

    def _check(self, value: str) -> str:
        if value == self._default or value in (known := list(self._names())):
            return value
        names = [repr(name) for name in known]
        expected = " or ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else "".join(names)
        expected = expected or "one that an installed package brings, and none does"
        raise PydanticCustomError("literal_error", "{expected}", {"expected": expected})
