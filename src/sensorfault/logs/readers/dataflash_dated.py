"""Messages without a time, in old DataFlash text logs: their place among messages that have one says when they came."""

from collections.abc import Sequence

import numpy as np
import polars as pl

PLACE = "time_of_place"


def dated(frame: pl.DataFrame, lines: Sequence[int], time: pl.Series, timed: Sequence[int]) -> pl.DataFrame:
    """The rows that lie between two with a time, with the time in PLACE, drawn linearly from line to line.

    Args:
        frame: rows, each from one of `lines`, in order.
        time: what the lines `timed` say.
    """
    known = time.cast(pl.Float64).to_numpy()
    sure = np.isfinite(known)
    if not sure.any() or not frame.width:
        return frame.clear().with_columns(pl.Series(PLACE, [], pl.Float64))
    when = np.interp(lines, np.asarray(timed)[sure], known[sure], left=np.nan, right=np.nan)
    return frame.with_columns(pl.Series(PLACE, when)).filter(pl.col(PLACE).is_finite())
