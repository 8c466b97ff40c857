"""A TOML table read strictly: an unknown key or a wrong type is an error."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sensorfault.logs.table import LogError


@dataclass(frozen=True)
class TomlTable:
    """A TOML table that refuses unknown keys."""

    content: Any  # a mapping, or the first use says so
    where: str
    path: str

    def __post_init__(self) -> None:
        if not isinstance(self.content, Mapping):
            raise LogError(f"{self.where}: '{self.path}' must be a table; write [{self.path}] above its keys.")

    def only(self, *keys: str) -> None:
        unknown = [key for key in self.content if key not in keys]
        if unknown:
            place = f"[{self.path}]" if self.path else "the top"
            raise LogError(f"{self.where}: {place} has an unknown key '{unknown[0]}'; take one of {', '.join(keys)}.")

    def tables(self, key: str) -> list[tuple[str, "TomlTable"]]:
        path = f"{self.path}.{key}" if self.path else key
        content = self.content.get(key)
        if content is None:
            raise LogError(f"{self.where}: there is no [{path}.NAME] table; write at least one.")
        inner = TomlTable(content, self.where, path).content
        return [(name, TomlTable(table, self.where, f"{path}.{name}")) for name, table in inner.items()]

    def text(self, key: str) -> str | None:
        value: str | None = self._get(key, str, "a text in quotes")
        return value

    def flag(self, key: str, default: bool) -> bool:
        value: bool | None = self._get(key, bool, "true or false")
        return default if value is None else value

    def number(self, key: str) -> float | None:
        value = self._get(key, (int, float), "a number")
        return None if value is None else float(value)

    def _get(self, key: str, kind: type | tuple[type, ...], words: str) -> Any:
        value = self.content.get(key)
        if value is not None and (not isinstance(value, kind) or (kind is not bool and isinstance(value, bool))):
            raise LogError(f"{self.where}: [{self.path}] {key} = {value!r} must be {words}.")
        return value
