"""pyulog with the place of damage, and with parts of a file while it is read."""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pyulog import ULog

from sensorfault.logs.readers.source import PART
from sensorfault.logs.readers.telling import open_telling


class Loaded(ULog):  # type: ignore[misc]
    """What pyulog reads of a file. `take`: is called with the topics so far whenever they reach PART numbers.

    `data_list`: the topics, without what went to `take`. `broken_at`: position in the file where its first broken
    message was noticed. `left`: bytes of a header at which the file ended; None if it ended after a header.
    `lost_s`: how often, and for how long together [s], the autopilot could not write.
    """

    def __init__(
        self,
        path: Path,
        names: list[str] | None,
        tell: Callable[[float], None],
        take: Callable[[list[Any]], None] | None,
    ) -> None:
        self.broken_at: int | None = None
        self.left: int | None = None
        self.lost, self.lost_s = 0, 0.0
        self.due = False
        self._tell, self._take = tell, take
        super().__init__(None)
        self._MessageHeader = lambda: _header(self)
        self._MessageAddLogged = self._announced
        with open_telling(path, self._heard) as self._opened:
            self._load_file(self._opened, names)
        self._count_lost()

    def hand_on(self) -> None:
        """All topics that have been gathered, which are then forgotten, with whatever else grows with the file."""
        self.due = False
        topics = [*self._data_list, *(ULog.Data(one) for one in self._subscriptions.values() if one.buffer)]
        self._data_list.clear()
        for one in self._subscriptions.values():
            one.buffer = bytearray()
        for text in (self._logged_messages, self._logged_messages_tagged, self._msg_info_multiple_dict):
            text.clear()
        self._changed_parameters.clear()
        self._count_lost()
        assert self._take is not None
        self._take(topics)

    def _heard(self, share: float) -> None:
        """Called between messages, once for each buffer that is read from the file."""
        if self._take is not None:
            gathered = sum(
                len(one.buffer) // max(1, one.dtype.itemsize) * len(one.field_data)
                for one in self._subscriptions.values()
            )
            self.due = gathered + sum(len(field) for one in self._data_list for field in one.data.values()) >= PART
        self._tell(share)

    def _announced(self, *message: Any) -> Any:
        """A new topic. One that had its number before had data, which pyulog would forget."""
        new = ULog._MessageAddLogged(*message)
        before = self._subscriptions.get(new.msg_id)
        if before is not None and before.buffer:
            self._data_list.append(ULog.Data(before))
            before.buffer = bytearray()
        return new

    def _count_lost(self) -> None:
        self.lost += len(self._dropouts)
        self.lost_s += sum(one.duration for one in self._dropouts) / 1e3
        self._dropouts.clear()

    @property
    def _file_corrupt(self) -> bool:
        return self.broken_at is not None

    @_file_corrupt.setter
    def _file_corrupt(self, corrupt: bool) -> None:
        if corrupt and self.broken_at is None:
            self.broken_at = self._opened.tell()


def _header(log: Loaded) -> Any:
    """What pyulog reads the size and kind of each message into."""
    unpack = struct.Struct("<HB").unpack

    class Header:
        def initialize(self, data: bytes) -> None:
            if log.due:
                log.hand_on()
            try:
                self.msg_size, self.msg_type = unpack(data)
            except struct.error:
                log.left = len(data)
                raise

    return Header()
