"""Threshold-free measures: how well a score ranks faulty samples above healthy ones."""

import numpy as np
from jaxtyping import Bool, Float


def auc(score: Float[np.ndarray, " N"], faulty: Bool[np.ndarray, " N"]) -> float:
    """Area under the receiver operating characteristic; NaN if one class is empty.

    The Mann-Whitney statistic: probability that a faulty sample scores above a healthy one; ties count half.
    """
    positive, negative = int(faulty.sum()), int((~faulty).sum())
    if not positive or not negative:
        return float("nan")
    _, at, count = np.unique(score, return_inverse=True, return_counts=True)
    rank = (np.cumsum(count) - (count - 1) / 2)[at]  # mean rank of each tie
    # U = R - n (n + 1) / 2, AUC = U / (n m)
    return float((rank[faulty].sum() - positive * (positive + 1) / 2) / (positive * negative))


def auc_pr(score: Float[np.ndarray, " N"], faulty: Bool[np.ndarray, " N"]) -> float:
    """Average precision: the area under precision over recall as a step function; NaN without a faulty sample."""
    positive = int(faulty.sum())
    if not positive:
        return float("nan")
    order = np.argsort(-score, kind="stable")
    last_of_tie = np.flatnonzero(np.append(np.diff(score[order]) != 0, True))
    true = np.cumsum(faulty[order])[last_of_tie]
    precision = true / (last_of_tie + 1)
    # AP = sum (R_n - R_n-1) P_n
    return float(np.sum(np.diff(true, prepend=0) / positive * precision))
