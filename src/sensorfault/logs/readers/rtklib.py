"""RTKLIB's solution files (.pos) and the time tags it writes beside a recorded stream (.tag)."""

import re
import struct
from pathlib import Path

import numpy as np
import polars as pl
from jaxtyping import Float

from sensorfault.logs.readers.format import Format, one_table
from sensorfault.logs.readers.gps_time import WEEK_S, unix_from_gps_calendar, unix_from_gps_week
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

_FILLER = {b"", b"%", b"#"}
TIME = "time"


def read_pos(path: Path) -> Source:
    """A solution file: `time` [s, Unix] and the columns of its header line, e.g. `latitude(deg)`, `vn(m/s)`.

    The header's first words say which clock: `GPST` or `UTC`, as date and time or as GPS week and time of week.

    Raises:
        LogError: no header line, or no solutions.
    """
    raw = path.read_bytes()
    lines = raw.splitlines()
    header = next((line for line in lines if re.match(rb"%\s+(GPST|UTC|JST)\s", line)), None)
    rows = [
        re.sub(rb"[ \t,]+", b",", line.strip()) for line in lines if line.strip() and line.lstrip()[:1] not in b"%#"
    ]
    if header is None:
        raise LogError(
            f"{path}: no header line like '% GPST latitude(deg) ...'; let RTKLIB write one (out-outhead=on)."
        )
    if not rows:
        raise LogError(f"{path}: there is a header but no solution below it; name a log with rows.")
    clock, *names = header.decode("ascii", "replace").lstrip("%").split()
    first_line = next(i for i, line in enumerate(lines) if line.strip() and line.lstrip()[:1] not in b"%#") + 1
    columns = ["date", "clock", *names]
    try:
        frame = pl.read_csv(
            b"\n".join(rows),
            has_header=False,
            new_columns=columns,
            schema_overrides={"date": pl.String, "clock": pl.String, **dict.fromkeys(names, pl.Float64)},
            truncate_ragged_lines=True,
        )
        time = _unix(frame, clock)
    except (pl.exceptions.PolarsError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise LogError(f"{path}: the rows do not fit the header ({reason}); let RTKLIB write the file again.") from None
    numbers = frame.drop("date", "clock").insert_column(0, pl.Series(TIME, time))
    return Source(path, numbers, TIME, "s", first_line)


def _unix(frame: pl.DataFrame, clock: str) -> np.ndarray:
    """Both columns of the time -> Unix time [s]."""
    if "/" in frame["date"][0]:
        stamp = (frame["date"] + " " + frame["clock"]).str.to_datetime("%Y/%m/%d %H:%M:%S%.f", time_unit="us")
        calendar: Float[np.ndarray, " T"] = stamp.to_physical().to_numpy() / 1e6
        ahead = {"GPST": calendar[0] - unix_from_gps_calendar(calendar[0]), "UTC": 0.0, "JST": 9 * 3600.0}[clock]
        unix: Float[np.ndarray, " T"] = calendar - ahead
        return unix
    week, seconds = frame["date"].cast(pl.Float64).to_numpy(), frame["clock"].cast(pl.Float64).to_numpy()
    zero = unix_from_gps_week(week[0], seconds[0])
    time: Float[np.ndarray, " T"] = zero + (week - week[0]) * WEEK_S + (seconds - seconds[0])
    return time


def read_tag(path: Path, stream: Path, counter_s: np.ndarray, line: np.ndarray) -> tuple[float, float]:
    """Tie a counter inside a recorded stream to Unix time by the tags RTKLIB wrote beside it.

    A tag says how many bytes had arrived when: its GPS time belongs to the last row that was whole by then. Layout:
    a header of 60 bytes, tick [u4, ms], GPS time [u4 s, f8 s], then pairs of tick [ms since that time] and byte count.

    Args:
        path: the .tag file.
        stream: the text file that it belongs to.
        counter_s: readings of the counter [s], shape (T,).
        line: the line of the stream that each reading stands in, counted from 1, shape (T,).

    Returns:
        Unix time at counter 0 [s], and seconds of GPS time per second of counter (1 for a perfect clock).

    Raises:
        LogError: not a tag file, or one of another stream.
    """
    if not path.is_file():
        raise LogError(f"{path}: there is no time tag; put it beside {stream.name}, or take the key 'tag' out.")
    raw = path.read_bytes()
    if raw[:14] != b"TIMETAG RTKLIB" or len(raw) < 76 + 8 * 2:
        raise LogError(f"{path}: this is not a time tag of RTKLIB; take the key 'tag' out of vehicle.toml.")
    second, fraction = struct.unpack("<Id", raw[64:76])
    pair = np.frombuffer(raw, "<u4", offset=76, count=(len(raw) - 76) // 8 * 2).reshape(-1, 2)
    pair = pair[np.diff(pair[:, 1], prepend=0) > 0]  # a tag that brought nothing says nothing of when
    text = stream.read_bytes()
    end = 1 + np.flatnonzero(np.frombuffer(text, np.uint8) == ord("\n"))
    if pair[-1, 1] == len(text) + len(end) and b"\r" not in text:
        end = end + 1 + np.arange(len(end))  # the stream came with \r\n, and something on the way took each \r
    elif pair[-1, 1] > len(text):
        raise LogError(
            f"{path}: it counts {pair[-1, 1]} bytes but {stream.name} has {len(text)}; find the file it belongs to."
        )
    whole = np.searchsorted(end, pair[:, 1], side="right")  # the last line that was whole by then
    at = np.searchsorted(line, whole, side="right") - 1
    seen = (at >= 0) & (whole <= line[-1])
    arrival, counter = pair[seen, 0] / 1e3, counter_s[at[seen]]
    rate, offset = np.polyfit(counter - counter[0], arrival, 1)
    start = unix_from_gps_calendar(second + fraction)
    return start + float(offset - rate * counter[0]), float(rate)


FORMAT = Format("RTKLIB solution", ("*.pos",), one_table(read_pos))
