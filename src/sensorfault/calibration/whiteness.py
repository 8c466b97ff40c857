"""How to thin out a healthy signal so that its samples are about independent."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

EVERY = (1, 2, 3, 5, 10, 20, 50)
WHITE = 0.2  # a smaller autocorrelation is accepted
FEW = 20  # samples that a window should have at least


@dataclass(frozen=True)
class Whiteness:
    """For each of W signals: take every `every`-th value x, and of these (x - `memory` x_before) / √(1 - memory²).

    `sigma`: standard deviation of the result (from its 16 and 84 % quantiles). `least`: samples needed to test a
    window.
    """

    every: Int[np.ndarray, " W"]
    memory: Float[np.ndarray, " W"]
    sigma: Float[np.ndarray, " W"]
    least: Float[np.ndarray, " W"]


def whiten(signals: Float[np.ndarray, "T W"], time: Float[np.ndarray, " T"], window_s: float) -> Whiteness:
    """Decimate healthy signals until they are white, or until FEW samples of a window are left; NaN: no value.

    The remaining correlation is removed by a first-order autoregression.
    """
    width = signals.shape[1]
    every, memory, sigma, least = np.ones(width, int), np.zeros(width), np.ones(width), np.full(width, np.inf)
    for k in range(width):
        there = np.isfinite(signals[:, k])
        x = signals[there, k]
        if x.size < FEW:
            continue
        usual = window_s / float(np.median(np.diff(time[there])))
        for n in EVERY:
            if n > 1 and usual / n < FEW:
                break
            every[k], memory[k] = n, autocorrelation(x[::n])
            # outliers come in clusters, so a window's kurtosis varies even where its mean does not
            if max(abs(memory[k]), autocorrelation(np.abs(x[::n]))) < WHITE:
                break
        memory[k] = np.clip(memory[k], -0.9, 0.9)
        taken = x[:: every[k]]
        white = (taken[1:] - memory[k] * taken[:-1]) / np.sqrt(1 - memory[k] ** 2)
        low, high = np.quantile(white, (0.16, 0.84))
        sigma[k] = max((high - low) / 2, 1e-12)
        least[k] = max(0.7 * usual / every[k], 8.0)
    return Whiteness(every, memory, sigma, least)


def autocorrelation(x: Float[np.ndarray, " N"]) -> float:
    """First-order autocorrelation of the ranks, so that a few outliers do not decide it."""
    rank = np.argsort(np.argsort(x)) / max(len(x) - 1, 1) * 2 - 1
    power = float((rank**2).sum())
    return float((rank[1:] * rank[:-1]).sum()) / power if power > 0 else 0.0
