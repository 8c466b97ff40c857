"""Features of measurements whose error is known, to learn from."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import LogError
from sensorfault.numerics.unit_range import UnitRange

LEAST = 20  # rows
SMALL = 0.01  # of the median feature: the logarithm of a smaller one says nothing


class Labelled(NamedTuple):
    """Features as numerics/innovation.py has them, and the size of each measurement's error [its unit]."""

    features: Float[np.ndarray, "N F"]
    target: Float[np.ndarray, " N"]


def joined(of: Iterable[Labelled]) -> Labelled:
    """All rows together."""
    return Labelled(*(np.concatenate(parts) for parts in zip(*of, strict=True)))


def checked(features: Float[np.ndarray, "N F"], target: Float[np.ndarray, " N"]) -> None:
    """See that there is something to learn from.

    Raises:
        LogError: too few rows, one that is not finite, or a feature that is below zero.
    """
    if len(features) < LEAST:
        raise LogError(f"{len(features)} measurements of known error are too few to learn from; give at least {LEAST}.")
    bad = ~(np.isfinite(features).all(axis=1) & np.isfinite(target))
    if bad.any():
        raise LogError(
            f"row {bad.argmax()} of the features to learn from is not finite ({bad.sum()} such rows); leave out "
            "measurements whose innovation or true error is not known."
        )
    if (features < 0).any():
        raise LogError(
            f"row {(features < 0).any(axis=1).argmax()} of the features to learn from is below zero; give sizes."
        )


def unit_range(features: Float[np.ndarray, "N F"], log: bool = False, reach: float = 0.0) -> UnitRange:
    """From the extremes of these rows (at least 0); a feature that is constant, or 0 throughout, keeps its unit.

    Xu et al. 2023, section 3.2. With `log`, a row below SMALL of the median counts as if it were there.
    """
    low, high = features.min(axis=0), features.max(axis=0)
    if log:
        least = np.maximum(low, SMALL * np.median(features, axis=0))
        low, high = (np.log(np.where(x > 0, x, 1.0)) for x in (least, high))
    return UnitRange(low, np.where(high > low, high - low, 1.0), np.asarray(reach), log)
