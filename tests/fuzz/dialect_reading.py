"""Read a drawn table: what is read is what was written, or one sentence says why not."""

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, Phase, given, settings

from fuzz.dialects import FORMS, Table, tables
from sensorfault.logs import LogError, guess
from sensorfault.logs.clock import read_clock
from sensorfault.logs.readers.formats import read_source
from sensorfault.logs.readers.source import Source

ENOUGH = 0.95  # share of the tables that must be read


@dataclass
class Tally:
    """What came of the tables: how many were read, why the others were not."""

    read: int = 0
    refused: Counter[str] = field(default_factory=Counter)
    cases: list[tuple[str, Table]] = field(default_factory=list)

    @property
    def share(self) -> float:
        """Of those that were read."""
        return self.read / max(1, self.read + self.refused.total())


def read_drawn(folder: Path, draws: int) -> Tally:
    """Write and read so many tables.

    Raises:
        AssertionError: something was read that was not written.
    """
    tally = Tally()

    @settings(
        max_examples=draws,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
        phases=[Phase.generate, Phase.shrink],
    )
    @given(tables())
    def one(table: Table) -> None:
        path = folder / "table.csv"
        table.write(path)
        try:
            vehicle = guess(path)
        except LogError as error:
            reason = str(error).removeprefix(f"{path}: ")
            assert reason.endswith((".", ")")), reason
            assert "\n" not in reason
            tally.refused[reason] += 1
            tally.cases.append((reason, table))
            return
        source = read_source(path)
        clock = read_clock(source, vehicle.files[0])
        check_time(table, clock.time, clock.zero_s, clock.rows)
        check_values(table, source, clock.rows)
        tally.read += 1

    one()
    return tally


def check_time(table: Table, time: np.ndarray, zero_s: float, rows: np.ndarray) -> None:
    form = FORMS[table.form]
    assert len(rows) == table.rows, f"{len(rows)} rows of {table.rows}"
    expected = table.time - table.time[0]
    assert np.abs(time - expected).max() <= 2 * form.exact_s + 1e-9, f"times {time[:3]} are not {expected[:3]}"
    if form.dated:
        assert abs(zero_s - table.start_s) <= 2 * form.exact_s + 1e-5, f"begins at {zero_s}, not {table.start_s}"


def check_values(table: Table, source: Source, rows: np.ndarray) -> None:
    for name, value in table.values().items():
        found = [column for column in source.frame.columns if column.split(" [")[0].split(" (")[0] == name]
        assert len(found) == 1, f"{name} is not among {source.frame.columns}"
        read = source.column(found[0]).to_numpy()[rows]
        np.testing.assert_allclose(read.astype(float), value, atol=1e-9, err_msg=name)
