"""KITTI's OXTS data: times in one file, and a file of numbers for each."""

from pathlib import Path

import numpy as np

ROWS = 12


def oxts(folder: Path) -> Path:
    (folder / "data").mkdir(exist_ok=True)
    for i, row in enumerate(np.random.default_rng(0).normal(0, 1, (ROWS, 30))):
        (folder / "data" / f"{i:010d}.txt").write_text(" ".join(map(str, row)))
    path = folder / "timestamps.txt"
    path.write_text("".join(f"2011-09-26 13:02:{20 + i / 10:012.9f}\n" for i in range(ROWS)))
    return path


SMALL = {"KITTI OXTS": oxts}
