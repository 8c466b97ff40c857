"""Training data: features of measurements whose error is known."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import LogError
from sensorfault.numerics.unit_range import UnitRange

LEAST = 20  # rows
SMALL = 0.01  # share of the median feature; smaller features are raised to this before the logarithm


class Labelled(NamedTuple):
    """Features as numerics/innovation.py has them, and the size of each measurement's error [its unit]."""

    features: Float[np.ndarray, "N F"]
    target: Float[np.ndarray, " N"]


def joined(of: Iterable[Labelled]) -> Labelled:
    """All rows as one set."""
    return Labelled(*(np.concatenate(parts) for parts in zip(*of, strict=True)))


def checked(features: Float[np.ndarray, "N F"], target: Float[np.ndarray, " N"]) -> None:
    """Check that the rows can be used for training.

    Raises:
        LogError: too few rows, a row that is not finite, or a negative feature.
    """
    if len(features) < LEAST:
        raise LogError(f"{len(features)} measurements of known error are too few to train on; give at least {LEAST}.")
    bad = ~(np.isfinite(features).all(axis=1) & np.isfinite(target))
    if bad.any():
        raise LogError(
            f"row {bad.argmax()} of the training features is not finite ({bad.sum()} such rows); leave out "
            "measurements whose innovation or true error is not known."
        )
    if (features < 0).any():
        raise LogError(
            f"row {(features < 0).any(axis=1).argmax()} of the training features is negative; give absolute values."
        )


def unit_range(features: Float[np.ndarray, "N F"], log: bool = False, reach: float = 0.0) -> UnitRange:
    """From the extremes of these rows (at least 0); a constant feature is not scaled.

    Xu et al. 2023, section 3.2. With `log`, values below SMALL times the median count as SMALL times the median.
    """
    low, high = features.min(axis=0), features.max(axis=0)
    if log:
        least = np.maximum(low, SMALL * np.median(features, axis=0))
        low, high = (np.log(np.where(x > 0, x, 1.0)) for x in (least, high))
    return UnitRange(low, np.where(high > low, high - low, 1.0), np.asarray(reach), log)
