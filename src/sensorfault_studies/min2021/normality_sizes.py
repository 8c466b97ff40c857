"""False alarm rate of the Jarque-Bera test: by sampling rate, by decimation, and on simulated numbers."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.numerics.normality import jarque_bera_quantile
from sensorfault.stages.residual.bicycle_kalman import BicycleKalman
from sensorfault.training.bicycle import WARM_S, fit_bicycle, normalised
from sensorfault.vehicles.car import roles
from sensorfault_studies.findings import Row

WINDOW_S = 10.0
LEVEL = 0.05
DECIMATIONS = (1, 2, 5, 10)
PAPER_LARGEST = 0.34
LEAST = 8


def jarque_bera(x: Float[np.ndarray, "*s n"]) -> Float[np.ndarray, "*s"]:
    """Jarque-Bera statistic over the last axis. Min et al. 2021, equations (24)-(26)."""
    d = x - x.mean(axis=-1, keepdims=True)
    variance = np.maximum((d**2).mean(axis=-1), 1e-300)
    skewness, kurtosis = (d**3).mean(axis=-1) / variance**1.5, (d**4).mean(axis=-1) / variance**2
    return np.asarray(x.shape[-1] / 6 * (skewness**2 + (kurtosis - 3) ** 2 / 4))


def windows(signal: Float[np.ndarray, " T"], time: Float[np.ndarray, " T"], every: int) -> list[np.ndarray]:
    """Every `every`-th value of a signal, in windows of 10 s."""
    there = np.isfinite(signal)
    x, t = signal[there][::every], time[there][::every]
    cuts = np.searchsorted(t, np.arange(time[0], time[-1], WINDOW_S))
    return [part for part in np.split(x, cuts) if part.size >= LEAST]


def interpolated(log: Log) -> Log:
    """Every channel interpolated linearly to every tick, as in the paper's soft synchronisation."""
    value = log.value.copy()
    for column in range(value.shape[1]):
        rows = log.fresh[:, column] & np.isfinite(value[:, column])
        wrap = log.channels[column].name == "course"
        known = np.unwrap(value[rows, column]) if wrap else value[rows, column]
        value[:, column] = np.interp(log.time, log.time[rows], known)
    return replace(log, value=value, fresh=np.ones_like(log.fresh))


def sizes(data: str, log: Log, filter: BicycleKalman) -> tuple[list[Row], dict[str, list[np.ndarray]]]:
    """Share of healthy windows of both position channels that a 5 % test rejects; and the windows."""
    position = list(filter.columns.position)
    soft = interpolated(log)
    smooth = fit_bicycle(soft, roles(soft), log.wheelbase_m, log.steering_ratio)
    signals = {"every-tick": normalised(smooth, soft)[:, position], "epochs": normalised(filter, log)[:, position]}
    rows, kept = [], {}
    for name, signal in signals.items():
        signal[log.time < log.time[0] + WARM_S] = np.nan
        for every in DECIMATIONS if name == "epochs" else (1,):
            condition = name if every == 1 else f"{name} x{every}"
            parts = [part for column in signal.T for part in windows(column, log.time, every)]
            if not parts:
                continue
            kept[condition] = parts
            jb = np.array([float(jarque_bera(part)) for part in parts])
            limit = jarque_bera_quantile(np.array([float(len(part)) for part in parts]), 1 - LEVEL)
            numbers = {
                "far": (float((jb > limit).mean()), None),
                "largest": (float(jb.max()), PAPER_LARGEST),
                "median": (float(np.median(jb)), None),
                "below_paper": (float((jb <= PAPER_LARGEST).mean()), None),
            }
            rows += [
                Row("A3", data, "real", condition, "jarque-bera", None, None, metric, value, None, len(jb), paper)
                for metric, (value, paper) in numbers.items()
            ]
    return rows, kept


def simulated(seeds: int) -> Iterator[Row]:
    """On simulated numbers: correlated, independent, and the quantiles for finite samples."""
    random = np.random.default_rng(0)
    count, n = 400 * max(seeds, 1), 500
    noise = random.standard_normal((count, n + 100))
    ar = np.zeros_like(noise)
    for t in range(1, noise.shape[1]):
        ar[:, t] = 0.9 * ar[:, t - 1] + np.sqrt(1 - 0.81) * noise[:, t]
    for condition, x in (("ar0.9", ar[:, 100:]), ("ar0.9 x10", ar[:, 100::10]), ("independent", noise[:, 100:])):
        rejected = jarque_bera(x) > jarque_bera_quantile(float(x.shape[1]), 1 - LEVEL)
        yield Row("A3", "simulated", "simulated", condition, "jarque-bera", None, None, "far", float(rejected.mean()))
    calm = float((jarque_bera(noise[:, 100:]) <= PAPER_LARGEST).mean())
    yield Row("A3", "simulated", "simulated", "independent", "jarque-bera", None, None, "below_paper", calm)
    for few in (20, 50, 98, 500):
        point = float(jarque_bera_quantile(float(few), 1 - LEVEL))
        yield Row("A3", "simulated", "simulated", f"n{few}", "jarque-bera", None, None, "quantile95", point)
    # what the test cannot detect: a window shifted by three standard deviations, or made twice as wide
    normal = noise[:, 100:]
    plain = jarque_bera(normal) > jarque_bera_quantile(float(n), 1 - LEVEL)
    for fault, changed in (("offset", normal + 3.0), ("scale", 2.0 * normal)):
        size = 3.0 if fault == "offset" else 2.0
        tests = {
            "jarque-bera": jarque_bera(changed) > jarque_bera_quantile(float(n), 1 - LEVEL),
            "mean": np.sqrt(n) * np.abs(changed.mean(axis=1)) > 1.96,
            "variance": np.sqrt(n / 2) * np.abs(np.log(changed.var(axis=1))) > 1.96,
        }
        for method, rejected in tests.items():
            share = float(rejected.mean())
            yield Row("A3", "simulated", "simulated", "whole-window", method, fault, size, "detection_rate", share)
    yield Row("A3", "simulated", "simulated", "whole-window", "jarque-bera", None, None, "far", float(plain.mean()))
