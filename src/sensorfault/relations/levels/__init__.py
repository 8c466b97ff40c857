"""What must be so at every moment, whatever the others say: a change detector and its slow mean hide exactly these."""

from collections.abc import Iterator

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels import bounds, inertial, ranges, ratios, repeats, spikes
from sensorfault.relations.levels.finding import Finding
from sensorfault.relations.levels.silence import silences as silences


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """All findings in a piece."""
    yield from soon(grid, vehicle)
    yield from late(grid, vehicle)


def soon(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Those that some seconds show."""
    for level in (inertial, bounds, ranges, spikes):
        yield from level.findings(grid, vehicle)


def late(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Those that need a minute: what is usual, or a mean."""
    for level in (repeats, ratios):
        yield from level.findings(grid, vehicle)
