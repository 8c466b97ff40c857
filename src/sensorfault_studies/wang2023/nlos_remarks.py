"""What the numbers of smartLoc say, in sentences."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from sensorfault_studies.numbers import Numbers

NONE = "no-exclusion"
LOST_M = 1e3


def remarks(numbers: Numbers, nlos: Float[np.ndarray, "T S"]) -> tuple[str, ...]:
    """What exclusion brings, how well a detour can be told at all, and how much hangs on the setting."""
    return tuple(_remarks(numbers, nlos))


def _remarks(numbers: Numbers, nlos: Float[np.ndarray, "T S"]) -> Iterator[str]:
    for wheels in ("wheels", "bare"):
        words = f"carrier {wheels}"
        before, after = ([numbers.mean(words, method, f"error_p{p}_m") for p in (50, 95)] for method in (NONE, "late"))
        yield (
            f"smartLoc, {'with' if wheels == 'wheels' else 'without'} wheels: leaving out what is late takes the "
            f"horizontal error from {before[0]:.1f} to {after[0]:.1f} m (50 %) and from {before[1]:.1f} to "
            f"{after[1]:.1f} m (95 %)."
        )
    known = np.isfinite(nlos)
    alone, place, found = (
        "{:.2f} (GPS {:.2f})".format(*(numbers.mean(words, method, metric) for metric in ("auc", "auc_gps")))
        for words, method in (("cn0-alone", NONE), ("known-place", NONE), ("carrier wheels", "late"))
    )
    yield (
        f"smartLoc: {int(known.sum())} labels in the first minute, {np.mean(nlos[known]):.0%} out of sight. "
        f"Innovations of the filter with wheels rank them with an AUC of {found}, C/N0 alone with {alone}, residuals "
        f"at the true place with the clock of satellites in sight with {place}: about as well as ranges can tell."
    )
    others = [row for row in numbers.rows() if row.method == "late" and row.condition.endswith("wheels")]
    low, high = ([f(r.value for r in others if r.metric == f"error_p{p}_m") for p in (50, 95)] for f in (min, max))
    yield (
        f"smartLoc: noises and limit were chosen by this log, among a hundred; with others the error with wheels is "
        f"{low[0]:.1f} to {high[0]:.1f} m (50 %) and {low[1]:.1f} to {high[1]:.1f} m (95 %)."
    )
    wild = sorted({row.condition for row in numbers.rows() if row.metric == "error_p95_m" and row.value > LOST_M})
    if wild:
        yield f"smartLoc: a test of both sides with noise as under an open sky loses the car ({', '.join(wild)})."
