"""Handing on a long file part by part."""

from dataclasses import replace

from sensorfault.logs.readers.source import Ask, Tables


class Handing:
    """Hands on parts to who asked for them. `begun`: whether there has been one."""

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
        """The tables of the last part, and no row of those before: what is said of the file needs a place to stand."""
        return self._empty | tables
