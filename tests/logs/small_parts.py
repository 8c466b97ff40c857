"""Parts of a few hundred rows, so that a small file has many."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from unittest.mock import patch

from sensorfault.logs.readers import csv, dataflash_load, dataflash_text, parquet, telling, topics, ulog_load

_SIZES = {
    (csv, "_PART_BYTES"): 8,
    (parquet, "PART"): 1,
    (topics, "PART"): 1,
    (telling, "_BUFFER_BYTES"): 1,
    (ulog_load, "PART"): 1,
    (dataflash_load, "PIECE_BYTES"): 5,
    (dataflash_text, "PART_CELLS"): 2,
}


@contextmanager
def small_parts(unit: int = 1000) -> Iterator[None]:
    """`unit`: numbers that are a part; bytes and cells accordingly."""
    with ExitStack() as patched:
        for (module, name), units in _SIZES.items():
            patched.enter_context(patch.object(module, name, unit * units))
        yield
