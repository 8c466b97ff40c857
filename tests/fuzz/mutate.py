"""Damage to a file as disks, cables and people do it: always the same for the same number."""

import random

_WORDS = (
    b"nan",
    b"-inf",
    b"1e999",
    b"",
    b"-1",
    b"\xff\xfe",
    b"99999999999999999999",
    b'"',
    b"\n\n",
    b"\x00" * 64,
    b";",
)


def mutated(content: bytes, number: int) -> bytes:
    """The content with one to four damages; the number says which."""
    chance = random.Random(number)
    for _ in range(chance.randint(1, 4)):
        content = chance.choice(_DAMAGES)(content, chance)
    return content


def _place(content: bytes, chance: random.Random) -> int:
    """Anywhere, and often in the first bytes, where headers are."""
    return chance.randrange(min(len(content), chance.choice((32, 512, 1 << 30))) or 1)


def _cut(content: bytes, chance: random.Random) -> bytes:
    return content[: _place(content, chance)]


def _flipped(content: bytes, chance: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(chance.choice((1, 1, 8, 64)) if changed else 0):
        changed[_place(content, chance)] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _other_bytes(content: bytes, chance: random.Random) -> bytes:
    at, length = _place(content, chance), chance.choice((1, 2, 4, 8, 100))
    return content[:at] + chance.choice((chance.randbytes(length), b"\xff" * length)) + content[at + length :]


def _put_in(content: bytes, chance: random.Random) -> bytes:
    at = _place(content, chance)
    return content[:at] + chance.choice(_WORDS) + content[at:]


def _taken_out(content: bytes, chance: random.Random) -> bytes:
    at = _place(content, chance)
    return content[:at] + content[at + chance.choice((1, 4, 50, 1000)) :]


def _twice(content: bytes, chance: random.Random) -> bytes:
    at, length = _place(content, chance), chance.choice((4, 100, 5000))
    return content[: at + length] + content[at:]


def _swapped(content: bytes, chance: random.Random) -> bytes:
    lines = content.splitlines(keepends=True)
    if len(lines) > 1:
        i, j = chance.randrange(len(lines)), chance.randrange(len(lines))
        lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines)


_DAMAGES = (_cut, _flipped, _other_bytes, _put_in, _taken_out, _twice, _swapped)
