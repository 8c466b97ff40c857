"""MAVLink telemetry of a ground station (`.tlog`): pairs of a time and a packet; by pymavlink."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.mavlink_clock import TIMED, Clocks, own_time
from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import Ask, Damage, Tables, with_notes
from sensorfault.logs.readers.telling import TellingFile
from sensorfault.logs.readers.topics import Topics
from sensorfault.logs.table import LogError
from sensorfault.logs.units import known, spelled

_TIME_BYTES = 8  # [us] since 1970, the highest byte first
_FRAMES = {0xFE: 8, 0xFD: 12}  # a packet's first byte -> its bytes beside the payload
_SIGNED, _SIGNATURE_BYTES = 1, 13
_AUTOPILOT = 1  # its component number
_HEAD_BYTES = 3
_BEGINNING_BYTES = 1 << 19  # enough packets to see how quick the quickest arrives


def _nobody(share: float) -> None:
    """Takes no share of the progress."""


def read_tlog(path: Path, ask: Ask) -> Tables:
    """Every kind of message, at the vehicle's own times on the ground station's clock; at arrival where it says none.

    `NAME[255.190]` comes from another system and component.

    Raises:
        LogError: empty, or no packet in it that can be read.
    """
    with quiet() as aloud:
        with TellingFile(path, _nobody) as file:
            beginning = _Telemetry(path, Ask(frozenset()))
            beginning.read(file, _BEGINNING_BYTES)
        part = None if ask.part is None else aloud(ask.part)
        with TellingFile(path, aloud(ask.tell)) as file:
            telemetry = _Telemetry(path, replace(ask, part=part), beginning.clocks)
            telemetry.read(file)
    tables, notes = telemetry.topics.tables()
    if not tables and ask.tables is None:
        raise LogError(f"{path}: no MAVLink packet in this file; name a .tlog file as a ground station wrote it.")
    return with_notes(tables, notes, telemetry.damage())


class _Telemetry:
    """Packets by kind, and how many bytes belong to none. Without `clocks` they are gathered."""

    def __init__(self, path: Path, ask: Ask, clocks: Clocks | None = None) -> None:
        from pymavlink.dialects.v20 import ardupilotmega

        self.ask = ask
        self.clocks, self._known = clocks or Clocks(), clocks is not None
        self.topics = Topics(path, ask, _unit_of(ardupilotmega.mavlink_map))
        self._decode = ardupilotmega.MAVLink(None).decode
        self._error = ardupilotmega.MAVError
        self._vehicle: int | None = None
        self._lost, self._first_lost = 0, 0
        self._ends: int | None = None

    def read(self, file: TellingFile, end: int | None = None) -> None:
        """Every packet; where none follows the other, the next one is looked for byte by byte."""
        while head := file.read(_TIME_BYTES + _HEAD_BYTES):
            start = file.tell() - len(head)
            if end is not None and start > end:
                return
            size = _size(head)
            packet = head + file.read(max(0, size - len(head)))
            if len(packet) < size:
                self._ends = start if self._ends is None else self._ends
            elif size and self._take(packet, file):
                self._ends = None
                continue
            self._lost, self._first_lost = self._lost + 1, self._first_lost if self._lost else start
            file.seek(start + 1)

    def _take(self, packet: bytes, file: TellingFile) -> bool:
        """Whether it is a packet. One of a type unknown here has no checksum to tell, but another follows it."""
        try:
            message = self._decode(bytearray(packet[_TIME_BYTES:]))
        except self._error:
            return False
        name, system, part = message.get_type(), message.get_srcSystem(), message.get_srcComponent()
        if self._vehicle is None and part == _AUTOPILOT:
            self._vehicle = system
        topic = name if (system, part) == (self._vehicle, _AUTOPILOT) else f"{name}[{system}.{part}]"
        if name.startswith("UNKNOWN"):
            if not _follows(file):
                return False
            self.topics.cannot(topic, "unknown MAVLink type")
        elif self.ask.wants(topic) or not self._known:
            received_ns = int.from_bytes(packet[:_TIME_BYTES], "big") * 1000
            self._keep(topic, name, system, received_ns, message.to_dict())
        return True

    def _keep(self, topic: str, name: str, system: int, received_ns: int, content: dict[str, Any]) -> None:
        own = own_time(content)
        if not self._known:
            if own is not None:
                self.clocks.see(system, own, received_ns)
            return
        if own is not None or TIMED & content.keys():
            at = received_ns if own is None else self.clocks.time(system, own, received_ns)
            content["timestamp"] = {"sec": at // 10**9, "nsec": at % 10**9}
        self.topics.take(topic, name, received_ns, content)

    def damage(self) -> list[Damage]:
        """What was no packet."""
        if self._ends is not None and self._ends == self._first_lost:
            return [Damage("the file breaks off inside the packet", f"byte {self._ends}")]
        if not self._lost:
            return []
        what = f"{self._lost} bytes are not in a whole packet, the first"
        return [Damage(what, f"byte {self._first_lost}", "the others were read")]


def _follows(file: TellingFile) -> bool:
    """Whether a packet begins here, or the file ends."""
    start = file.tell()
    head = file.read(_TIME_BYTES + _HEAD_BYTES)
    file.seek(start)
    return not head or _size(head) > 0


def _size(head: bytes) -> int:
    """Bytes of the packet that begins here; 0 if none does."""
    if len(head) < _TIME_BYTES + _HEAD_BYTES or head[_TIME_BYTES] not in _FRAMES:
        return 0
    first, payload, flags = head[_TIME_BYTES:]
    signature = _SIGNATURE_BYTES if first == 0xFD and flags & _SIGNED else 0
    return _TIME_BYTES + _FRAMES[first] + payload + signature


def _unit_of(kinds: dict[int, Any]) -> Callable[[str, str], str]:
    """What looks up the unit of a field of a kind of message."""
    units = {kind.msgname: kind.fieldunits_by_name for kind in kinds.values()}

    def unit(kind: str, field: str) -> str:
        found = spelled(units.get(kind, {}).get(field.partition("[")[0], ""))
        return found if known(found) else ""

    return unit


FORMAT = Format("MAVLink telemetry", ("*.tlog",), remembering(read_tlog), parts=True)
