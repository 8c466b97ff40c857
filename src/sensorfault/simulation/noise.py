"""Random signals with a given spectrum, shaped in the frequency domain (no loop over samples)."""

import numpy as np
from jaxtyping import Float


def shaped(rng: np.random.Generator, samples: int, density: Float[np.ndarray, " F"]) -> Float[np.ndarray, " samples"]:
    """Gaussian noise of variance 1 whose power spectrum has this shape.

    `density` belongs to the F = n/2 + 1 frequencies `np.fft.rfftfreq(n)` of an even n ≥ samples; the rest beyond
    `samples` is cut off, so that the end is not correlated with the beginning.
    """
    n = 2 * (len(density) - 1)
    # White noise has the same power at each frequency; √density shapes it, and the mean over all n makes it variance 1.
    both_sides = 2 * density.sum() - density[0] - density[-1]
    spectrum = np.fft.rfft(rng.standard_normal(n)) * np.sqrt(density * n / both_sides)
    return np.fft.irfft(spectrum, n).take(np.arange(samples))


def _even(samples: float) -> int:
    return 2 * int(np.ceil(samples / 2))


def gauss_markov(
    rng: np.random.Generator, samples: int, step: float, time_constant: float
) -> Float[np.ndarray, " samples"]:
    """First-order Gauss-Markov process of variance 1: correlation e^(-|τ| / time_constant) (`step` in its unit)."""
    n = _even(samples + 5 * time_constant / step)
    a = np.exp(-step / time_constant)
    # x⁺ = a x + w has the spectrum 1 / |1 - a e^(-iω)|²
    return shaped(rng, samples, 1 / np.abs(1 - a * np.exp(-2j * np.pi * np.fft.rfftfreq(n))) ** 2)


def band(
    rng: np.random.Generator, samples: int, rate_hz: float, centre_hz: float, width: float
) -> Float[np.ndarray, " samples"]:
    """Noise of variance 1 around `centre_hz`: a bell over log frequency with standard deviation `width` (0.7: octave).

    The part of the bell above half the sampling rate is left out.
    """
    n = _even(samples + 5 * rate_hz / centre_hz)
    f = np.fft.rfftfreq(n, 1 / rate_hz)
    density = np.zeros_like(f)
    density[1:] = np.exp(-0.5 * (np.log(f[1:] / centre_hz) / width) ** 2)
    return shaped(rng, samples, density)


def smooth(x: Float[np.ndarray, " T"], width: int) -> Float[np.ndarray, " T"]:
    """Centred average with a raised-cosine window of about `width` samples; the end values are extended."""
    half = max(width // 2, 1)
    window = np.hanning(2 * half + 3)[1:-1]
    return np.convolve(np.pad(x, half, mode="edge"), window / window.sum(), mode="valid")
