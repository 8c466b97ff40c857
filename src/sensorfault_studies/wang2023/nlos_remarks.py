"""Remarks on the numbers of smartLoc."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from sensorfault_studies.numbers import Numbers

NONE = "no-exclusion"
LOST_M = 1e3


def remarks(numbers: Numbers, nlos: Float[np.ndarray, "T S"]) -> tuple[str, ...]:
    """The benefit of exclusion, the limit of any detection of reflected signals, and the effect of the setting."""
    return tuple(_remarks(numbers, nlos))


def _remarks(numbers: Numbers, nlos: Float[np.ndarray, "T S"]) -> Iterator[str]:
    for wheels in ("wheels", "bare"):
        words = f"carrier {wheels}"
        before, after = ([numbers.mean(words, method, f"error_p{p}_m") for p in (50, 95)] for method in (NONE, "late"))
        yield (
            f"smartLoc, {'with' if wheels == 'wheels' else 'without'} wheel speed: excluding late signals changes the "
            f"horizontal error from {before[0]:.1f} to {after[0]:.1f} m (50 %) and from {before[1]:.1f} to "
            f"{after[1]:.1f} m (95 %)."
        )
    known = np.isfinite(nlos)
    alone, place, found = (
        "{:.2f} (GPS {:.2f})".format(*(numbers.mean(words, method, metric) for metric in ("auc", "auc_gps")))
        for words, method in (("cn0-alone", NONE), ("known-place", NONE), ("carrier wheels", "late"))
    )
    yield (
        f"smartLoc: {int(known.sum())} labels in the first minute, {np.mean(nlos[known]):.0%} without line of sight. "
        f"Innovations of the filter with wheel speed rank them with an AUC of {found}, C/N0 alone with {alone}. "
        f"Residuals at the true position with the clock of the satellites in sight reach {place}; pseudoranges allow "
        "about no more."
    )
    others = [row for row in numbers.rows() if row.method == "late" and row.condition.endswith("wheels")]
    low, high = ([f(r.value for r in others if r.metric == f"error_p{p}_m") for p in (50, 95)] for f in (min, max))
    yield (
        "smartLoc: noise and limit were chosen on this same log, among a hundred settings; with other settings the "
        f"error with wheel speed is {low[0]:.1f} to {high[0]:.1f} m (50 %) and {low[1]:.1f} to {high[1]:.1f} m (95 %)."
    )
    wild = sorted({row.condition for row in numbers.rows() if row.metric == "error_p95_m" and row.value > LOST_M})
    if wild:
        yield f"smartLoc: a two-sided test with the noise of an open sky loses the position ({', '.join(wild)})."
