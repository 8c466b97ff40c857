"""How to take samples of a healthy signal so that they are about independent."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

EVERY = (1, 2, 3, 5, 10, 20, 50)
WHITE = 0.2  # a smaller autocorrelation is let pass
FEW = 20  # samples a window should hold at least


@dataclass(frozen=True)
class Whiteness:
    """For each of W signals: take each `every`-th value, less `memory` times the one before over √(1 - memory²).

    `sigma` is the standard deviation of what is taken (between its 16 and 84 % quantiles), `least` how many make a
    window worth judging.
    """

    every: Int[np.ndarray, " W"]
    memory: Float[np.ndarray, " W"]
    sigma: Float[np.ndarray, " W"]
    least: Float[np.ndarray, " W"]


def whiten(signals: Float[np.ndarray, "T W"], time: Float[np.ndarray, " T"], window_s: float) -> Whiteness:
    """Of healthy signals, NaN where there is no value: decimate until white, or until FEW a window are left.

    What correlation is left is taken out by an autoregression of first order.
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
            # wild values come in clusters, which makes a window's kurtosis vary even where the mean does not
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
    """Of first order, of ranks mapped to [-1, 1], so that a few wild values do not decide it."""
    rank = np.argsort(np.argsort(x)) / max(len(x) - 1, 1) * 2 - 1
    power = float((rank**2).sum())
    return float((rank[1:] * rank[:-1]).sum()) / power if power > 0 else 0.0
