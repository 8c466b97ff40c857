"""Parquet."""

from pathlib import Path

import polars as pl

from fuzz.writing import COLUMNS


def parquet(folder: Path) -> Path:
    path = folder / "drive.parquet"
    pl.DataFrame(COLUMNS).write_parquet(path)
    return path


SMALL = {"Parquet": parquet}
