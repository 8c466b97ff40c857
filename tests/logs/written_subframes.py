"""What satellites of BeiDou and GLONASS send, bit by bit from the figures of their documents, as u-blox hands it on.

Each number is given as the whole number that stands in the message. Parity, and whatever is of no account here, is
written as ones, so that whoever reads it sees it.
"""

import re
from pathlib import Path

import numpy as np
from pyubx2 import GET, UBXMessage

# In the order in which it is sent: a number's name and how many bits of it follow, the highest first; _ is anything.
_WORD_1 = "_:15 number:3 second:8 _:4"
D1 = {
    1: """second:12 health:1 _:9 _:8  _:13 toc:9 _:8  toc:8 group_delay:10 _:4 _:8  _:22 _:8  _:22 _:8  _:22 _:8
          _:4 af2:11 af0:7 _:8  af0:17 af1:5 _:8  af1:17 _:5 _:8""",
    2: """second:12 delta_n:10 _:8  delta_n:6 cuc:16 _:8  cuc:2 anomaly:20 _:8  anomaly:12 eccentricity:10 _:8
          eccentricity:22 _:8  cus:18 crc:4 _:8  crc:14 crs:8 _:8  crs:10 sqrt_a:12 _:8  sqrt_a:20 toe_of_week:2 _:8""",
    3: """second:12 toe_of_week:10 _:8  toe_of_week:5 inclination:17 _:8  inclination:15 cic:7 _:8
          cic:11 node_rate:11 _:8  node_rate:13 cis:9 _:8  cis:9 inclination_rate:13 _:8
          inclination_rate:1 node:21 _:8  node:11 perigee:11 _:8  perigee:21 _:1 _:8""",
}
_PAGE = "second:12 page:4"
D2 = {
    1: f"{_PAGE} health:1 _:5 _:8  _:17 toc:5 _:8  toc:12 group_delay:10 _:8  _:22 _:8",
    2: f"{_PAGE} _:6 _:8  _:22 _:8  _:22 _:8  _:22 _:8",
    3: f"{_PAGE} _:6 _:8  _:22 _:8  _:10 af0:12 _:8  af0:12 af1:4 _:6 _:8",
    4: f"{_PAGE} af1:6 _:8  af1:12 af2:10 _:8  af2:1 _:5 delta_n:16 _:8  cuc:14 _:8 _:8",
    5: f"{_PAGE} cuc:4 anomaly:2 _:8  anomaly:22 _:8  anomaly:8 cus:14 _:8  cus:4 eccentricity:10 _:8 _:8",
    6: f"{_PAGE} eccentricity:6 _:8  eccentricity:16 sqrt_a:6 _:8  sqrt_a:22 _:8  sqrt_a:4 cic:10 _:8 _:8",
    7: f"{_PAGE} cic:6 _:8  cic:2 cis:18 toe_of_week:2 _:8  toe_of_week:15 inclination:7 _:8  inclination:14 _:8 _:8",
    8: f"{_PAGE} inclination:6 _:8  inclination:5 crc:17 _:8  crc:1 crs:18 node_rate:3 _:8  node_rate:16 _:6 _:8",
    9: f"{_PAGE} node_rate:5 node:1 _:8  node:22 _:8  node:9 perigee:13 _:8  perigee:14 _:8 _:8",
    10: f"{_PAGE} perigee:5 inclination_rate:1 _:8  inclination_rate:13 _:9 _:8  _:22 _:8  _:22 _:8",
}
GLONASS = {
    1: "idle:1 number:4 _:2 _:2 _:12 vx:24 ax:5 x:27 _:8",
    2: "idle:1 number:4 ill:1 _:2 _:1 quarter:7 _:5 vy:24 ay:5 y:27 _:8",
    3: "idle:1 number:4 _:1 drift:11 _:1 _:2 silent:1 vz:24 az:5 z:27 _:8",
    4: "idle:1 number:4 offset:22 _:5 _:5 _:14 _:1 _:4 _:3 _:11 _:5 _:2 _:8",
}


def sizes(message: dict[int, str]) -> dict[str, int]:
    """How many bits each number has."""
    found: dict[str, int] = {}
    for layout in message.values():
        for name, bits in _pieces(layout):
            found[name] = found.get(name, 0) + bits
    return {name: bits for name, bits in found.items() if name not in ("_", "second", "page", "number", "idle")}


def beidou(numbers: dict[str, int], second: int, paged: bool = False) -> list[tuple[int, ...]]:
    """The subframes that bear an ephemeris, the first sent at this second of BeiDou's week; `paged`: as D2."""
    left = {name: _twos(numbers[name], bits) for name, bits in sizes(D2 if paged else D1).items()}
    sent = []
    for number, layout in (D2 if paged else D1).items():
        own = {"number": f"{1 if paged else number:03b}", "page": f"{number:04b}"}
        own["second"] = f"{second + (3 if paged else 6) * (number - 1):020b}"
        bits = _laid(f"{_WORD_1} {layout}", left, own).ljust(300, "1")
        sent.append(tuple(int("10" + bits[at : at + 30], 2) for at in range(0, 300, 30)))
    return sent


def glonass(numbers: dict[str, int], frame: int) -> list[tuple[int, ...]]:
    """The four strings that bear a state."""
    left = {name: _signed(numbers[name], bits) for name, bits in sizes(GLONASS).items()}
    sent = []
    for number, layout in GLONASS.items():
        bits = _laid(layout, left, {"idle": "0", "number": f"{number:04b}"}).ljust(96, "1")
        sent.append((*(int(bits[at : at + 32], 2) for at in (0, 32, 64)), frame))
    return sent


def _pieces(layout: str) -> list[tuple[str, int]]:
    return [(name, int(bits)) for name, bits in re.findall(r"(\w+):(\d+)", layout)]


def _laid(layout: str, left: dict[str, str], own: dict[str, str]) -> str:
    """The bits of a subframe; what is taken of the numbers is no longer left."""
    row = ""
    for name, bits in _pieces(layout):
        of = own if name in own else left
        if name == "_":
            row += "1" * bits
        else:
            row, of[name] = row + of[name][:bits], of[name][bits:]
    return row


def _twos(number: int, bits: int) -> str:
    return f"{number % (1 << bits):0{bits}b}"


def _signed(number: int, bits: int) -> str:
    """A sign and a size."""
    return f"{abs(number) | (1 << (bits - 1) if number < 0 else 0):0{bits}b}"


WHOLE = {  # of no sign
    "eccentricity": 12_345_678, "sqrt_a": int(5282.6 * 2**19), "toe_of_week": 259_200 // 8, "toc": 259_200 // 8,
    "health": 0,
}  # fmt: skip


def orbit() -> dict[str, int]:
    """Numbers that use all their bits, with the sign that they have."""
    rng = np.random.default_rng(3)
    drawn = {n: int(rng.integers(-(2 ** (b - 1)), 2 ** (b - 1))) for n, b in sizes(D1).items()}
    return drawn | WHOLE


def strings() -> dict[str, int]:
    """A satellite over the equator at 12:15 of Moscow."""
    place = {"x": (-15_000 * 2**11), "y": (12_000 * 2**11), "z": int(-16_763.3 * 2**11)}
    speed = {"vx": int(-1.2 * 2**20), "vy": int(2.5 * 2**20), "vz": int(2.7 * 2**20)}
    clock = {"ill": 0, "silent": 0, "quarter": 49, "drift": -700, "offset": -1_000_000}
    return place | speed | clock | {"ax": -3, "ay": 2, "az": 1}


TOE_S = 3 * 86_400 + 9.25 * 3600 + 18  # of the GPS week: 12:15 in Moscow


def rover(path: Path) -> Path:
    """What u-blox logs of R05, and of C20 a little later than the reference time of its orbit: eleven epochs."""
    quarter = int(TOE_S - 900 - 14) // 8
    near = orbit() | {"toe_of_week": quarter, "toc": quarter}
    sent = [*_sent(6, 5, glonass(strings(), 7)), *_sent(3, 20, beidou(near, int(TOE_S) - 20))]
    said = [_raw(TOE_S + k) for k in range(-5, 6)]
    path.write_bytes(b"".join(one.serialize() for one in (said[0], *sent, *said[1:])))
    return path


def _sent(system: int, satellite: int, words: list[tuple[int, ...]]) -> list[UBXMessage]:
    about = {"gnssId": system, "svId": satellite, "sigId": 0, "numWords": len(words[0])}
    each = ({f"dwrd_{i:02}": word for i, word in enumerate(one, 1)} for one in words)
    return [UBXMessage("RXM", "RXM-SFRBX", GET, **about, **one) for one in each]


def _raw(second: float) -> UBXMessage:
    result: dict[str, float] = {"rcvTow": second, "week": 2381, "leapS": 18, "numMeas": 2}
    for i, (system, satellite) in enumerate(((6, 5), (3, 20)), 1):
        result |= {f"prMes_{i:02}": 2.1e7, f"gnssId_{i:02}": system, f"svId_{i:02}": satellite}
        result |= {f"cno_{i:02}": 40, f"prValid_{i:02}": 1}
    return UBXMessage("RXM", "RXM-RAWX", GET, **result)
