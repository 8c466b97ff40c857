"""A ULog of any topics, written byte by byte after PX4's description of the format: shares no code with the reader."""

import struct
from collections.abc import Mapping, Sequence

import numpy as np

TYPES = {"d": "double", "f": "float", "B": "uint8_t", "I": "uint32_t", "i": "int32_t", "Q": "uint64_t"}
START_US = 5_000_000


def ulog(topics: Mapping[tuple[str, int], tuple[str, float, Mapping[str, Sequence[float] | float]]]) -> bytes:
    """`(name, instance)` -> the letters of its fields' types, its rate [Hz] and its fields, a number or one a row.

    Each has as many rows as its longest field.
    """
    said = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1_000_000) + _message("B", bytes(40))
    described: set[str] = set()
    for (name, _), (form, _, fields) in topics.items():
        if name not in described:
            columns = "".join(_declared(TYPES[c], field) for c, field in zip(form, _firsts(fields), strict=True))
            said += _message("F", f"{name}:uint64_t timestamp;{columns}".encode())
            described.add(name)
    for number, (name, instance) in enumerate(topics):
        said += _message("A", struct.pack("<BH", instance, number) + name.encode())
    rows = []
    for number, (form, rate, fields) in enumerate(topics.values()):
        count = max(np.size(one) for one in fields.values())
        columns = [np.broadcast_to(one, (count,)) for one in fields.values()]
        letters = "".join(c * _length(f) for c, f in zip(form, _firsts(fields), strict=True))
        for k in range(count):
            us = START_US + round(1e6 * k / rate)
            values = [one[k] if c in "df" else int(one[k]) for c, one in zip(letters, columns, strict=True)]
            rows.append((us, _message("D", struct.pack("<HQ" + letters, number, us, *values))))
    return said + b"".join(row for _, row in sorted(rows, key=lambda row: row[0]))


def _message(kind: str, body: bytes) -> bytes:
    return struct.pack("<HB", len(body), ord(kind)) + body


def _firsts(fields: Mapping[str, object]) -> list[str]:
    """`q[0]`, `q[1]`, `x` -> `q[2]`, `x`."""
    names = [name.partition("[")[0] for name in fields]
    return [f"{name}[{names.count(name)}]" if f"{name}[0]" in fields else name for name in dict.fromkeys(names)]


def _length(field: str) -> int:
    return int(field.partition("[")[2].rstrip("]") or 1)


def _declared(kind: str, field: str) -> str:
    name, bracket, length = field.partition("[")
    return f"{kind}{bracket}{length} {name};"
