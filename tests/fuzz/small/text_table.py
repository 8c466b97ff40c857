"""Text tables, plain and packed."""

import gzip
from pathlib import Path

import polars as pl

from fuzz.writing import COLUMNS


def csv(folder: Path) -> Path:
    path = folder / "drive.csv"
    pl.DataFrame(COLUMNS).write_csv(path)
    return path


def gzipped(folder: Path) -> Path:
    plain = csv(folder)
    path = folder / "drive.csv.gz"
    path.write_bytes(gzip.compress(plain.read_bytes(), mtime=0))
    plain.unlink()
    return path


SMALL = {"text table": csv, "gzip": gzipped}
