"""Passing on a long file part by part."""

from dataclasses import replace

from sensorfault.logs.readers.source import Ask, Tables


class Handing:
    """Passes on parts to the caller. `begun`: whether there has been one."""

    def __init__(self, ask: Ask) -> None:
        self._part = ask.part
        self._empty: Tables = {}

    @property
    def asked(self) -> bool:
        """Whether anybody asked for parts."""
        return self._part is not None

    @property
    def begun(self) -> bool:
        return bool(self._empty)

    def on(self, tables: Tables) -> None:
        """The tables of a part, if there are any."""
        if self._part is None or not tables:
            return
        self._empty |= {name: replace(one, frame=one.frame.clear()) for name, one in tables.items()}
        self._part(tables)

    def rest(self, tables: Tables) -> Tables:
        """The tables of the last part; those of earlier parts without rows, to carry the file's notes."""
        return self._empty | tables
