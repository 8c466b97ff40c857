"""What must be so at every moment, whatever the others say: a change detector and its slow mean hide exactly these."""

from collections.abc import Iterator

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels import bounds, inertial, ranges, ratios, repeats, spikes
from sensorfault.relations.levels.finding import Finding
from sensorfault.relations.levels.silence import silences as silences


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """All findings in a piece."""
    for level in (inertial, bounds, ranges, repeats, ratios, spikes):
        yield from level.findings(grid, vehicle)
