"""Protocol buffers' message types -> decoders, by the descriptions that a recording holds."""

from functools import lru_cache
from typing import Any

from sensorfault.logs.readers.ros_types import Decoder


@lru_cache(maxsize=256)
def protobuf_decoder(kind: str, described: bytes) -> Decoder | None:
    """The decoder of a message type; None if the description does not have the type.

    Args:
        kind: `foxglove.LocationFix`.
        described: a FileDescriptorSet with the type and all that it is made of.
    """
    from google.protobuf.message_factory import GetMessageClass

    try:
        message = GetMessageClass(_pool(described).FindMessageTypeByName(kind))
    except Exception:  # damaged descriptions fail in many ways
        return None
    decode: Decoder = message.FromString
    return decode


def _pool(described: bytes) -> Any:
    """The types of a description, each file after those that it needs."""
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.descriptor_pool import DescriptorPool

    pool, added = DescriptorPool(), set[str]()
    waiting = list(FileDescriptorSet.FromString(described).file)
    while waiting:
        ready = [file for file in waiting if added.issuperset(file.dependency)]
        if not ready:
            raise ValueError(f"{waiting[0].name} needs a file that is not there")
        for file in ready:
            pool.Add(file)
            added.add(file.name)
        waiting = [file for file in waiting if file.name not in added]
    return pool
