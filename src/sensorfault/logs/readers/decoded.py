"""What the readers of recorded messages share: decode, collect, and count what cannot be decoded."""

from collections.abc import Hashable
from pathlib import Path

from sensorfault.logs.readers.ros_types import Decoder
from sensorfault.logs.readers.source import Ask, Damage, Tables, with_notes
from sensorfault.logs.readers.topics import Topics
from sensorfault.logs.table import LogError


class Recording:
    """Raw messages of known channels -> tables. `damage`: what the reader finds broken beside single messages."""

    def __init__(self, path: Path, ask: Ask) -> None:
        self.path, self.ask = path, ask
        self.damage: list[Damage] = []
        self._topics = Topics(path, ask)
        self._channels: dict[Hashable, tuple[str, str, Decoder]] = {}
        self._bad: dict[str, tuple[int, str]] = {}  # what is wrong: how often, and where first

    def open(self, channel: Hashable, topic: str, kind: str, decode: Decoder | None) -> None:
        """A channel: its topic, its messages' type and what decodes them, None if nobody can."""
        if not self.ask.wants(topic):
            return
        if decode is None:
            self._topics.cannot(topic, kind)
        else:
            self._channels[channel] = topic, kind, decode

    def take(self, channel: Hashable, received_ns: int, raw: bytes) -> bool:
        """One message; False if it cannot be decoded."""
        known = self._channels.get(channel)
        if known is None:
            return True
        topic, kind, decode = known
        try:
            self._topics.take(topic, kind, received_ns, decode(raw))
        except LogError:  # what takes the parts says so
            raise
        except Exception:  # a damaged message fails in as many ways as it can be damaged
            return False
        return True

    def cannot_decode(self, where: str) -> None:
        """A message that is not what its channel says."""
        self._count("messages cannot be decoded", where)

    def cannot_unpack(self, where: str) -> None:
        """A chunk of messages whose compression or checksum is wrong."""
        self._count("chunks cannot be unpacked", where)

    def _count(self, what: str, where: str) -> None:
        count, first = self._bad.get(what, (0, where))
        self._bad[what] = count + 1, first

    def tables(self) -> Tables:
        """All tables.

        Raises:
            LogError: there is none.
        """
        tables, notes = self._topics.tables()
        bad = (
            Damage(f"{count} {what}, the first", first, "the others were read")
            for what, (count, first) in self._bad.items()
        )
        damage = [*dict.fromkeys(self.damage), *bad]
        if not tables and self.ask.tables is None and not self._topics.handed_on:
            if damage:
                why = f" ({damage[0].what.rstrip(',')} at {damage[0].where}); copy it from the vehicle again"
            else:
                why = f"; {notes[0].rstrip('.')}" if notes else "; name one of a whole drive"
            raise LogError(f"{self.path}: no topic with numbers in this recording{why}.")
        return with_notes(tables, notes, damage)
