"""When a value counts: a condition on another column of its table, as `fix_type >= 2`."""

import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import LogError

_OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    ">=": operator.ge, "<=": operator.le, "==": operator.eq, "!=": operator.ne, ">": operator.gt, "<": operator.lt,
}  # fmt: skip
_FORM = re.compile(r"\s*(?P<column>.+?)\s*(?P<how>>=|<=|==|!=|>|<)\s*(?P<limit>[-+.\deE]+)\s*")


@dataclass(frozen=True)
class Validity:
    """`column how limit`; where the column has no value, what it is the condition of does not count."""

    column: str
    how: str
    limit: float

    @classmethod
    def parse(cls, text: str, where: str) -> "Validity":
        """The condition in a text; `where` names it in errors.

        Raises:
            LogError: it is none.
        """
        found = _FORM.fullmatch(text)
        try:
            return cls(found["column"], found["how"], float(found["limit"]))  # type: ignore[index]
        except (TypeError, ValueError):
            raise LogError(f"{where} '{text}' is no condition; write one like 'fix_type >= 2'.") from None

    def holds(self, value: Float[np.ndarray, " T"]) -> Bool[np.ndarray, " T"]:
        """The rows in which it does, by the values of its column."""
        met: Bool[np.ndarray, " T"] = _OPERATORS[self.how](value, self.limit) & ~np.isnan(value)
        return met
