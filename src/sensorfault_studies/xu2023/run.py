"""Run a monitor over a mission: flagged ranges and position error."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from sensorfault.core.monitor import Monitor, MonitorState
from sensorfault.core.types import Residual, Sample
from sensorfault.core.verdicts import FAULT
from sensorfault.numerics.local import east_north
from sensorfault.runtime.runners import samples
from sensorfault_studies.xu2023.scenario import Scenario


class Flown(NamedTuple):
    """For each tick: which of the L ranges are flagged, the residual, and the position error [m]."""

    flagged: Bool[np.ndarray, "T L"]
    residual: Residual
    off_m: Float[np.ndarray, " T"]


@jax.jit
def _through(monitor: Monitor, rows: Sample) -> tuple[Array, Any, Array]:
    def one(state: MonitorState, sample: Sample) -> tuple[MonitorState, tuple[Array, Any, Array]]:
        state, report = monitor.step(state, sample)
        return state, (report.verdict.channel, report.residual, state.residual.mean)

    result: tuple[Array, Any, Array] = lax.scan(one, monitor.init(), rows)[1]
    return result


@jax.jit
def _away(at: Float[Array, "T 2"], true: Float[Array, "T 2"]) -> Float[Array, " T"]:
    return jnp.hypot(*jax.vmap(lambda a, b: east_north(*a, *b))(at, true).T)


def through(monitor: Monitor, case: Scenario, least: int = 0) -> Flown:
    """The whole mission from the initial state; `least`: rows to compile for, so that one compilation serves many."""
    rows = len(case.log)
    after = [(0, max(least - rows, 0)), (0, 0)]
    value = np.pad(case.log.value, after, constant_values=np.nan)
    seen = samples(np.pad(case.log.time, after[0], "edge"), value, np.pad(case.log.fresh, after))
    channel, residual, at = jax.tree.map(lambda kept: kept[:rows], _through(monitor, seen))
    ranges = [i for i, channel in enumerate(case.log.channels) if channel.name == "range"]
    flagged = (np.asarray(channel)[:, ranges] == FAULT) & ~np.isnan(case.error)
    off = _away(at, jnp.asarray(case.position)) if case.geodetic else jnp.hypot(*(at[:, :2] - case.position).T)
    return Flown(flagged, jax.tree.map(np.asarray, residual), np.asarray(off))


def table(flagged: Bool[np.ndarray, "T L"], case: Scenario) -> Float[np.ndarray, "4"]:
    """TP, TN, FP, FN of the test ranges. Xu et al. 2023, section 4.2."""
    there = ~np.isnan(case.error) & case.judged[:, None]
    result, wrong = flagged[there], case.wrong[there]
    return np.array(
        [np.sum(result & wrong), np.sum(~result & ~wrong), np.sum(result & ~wrong), np.sum(~result & wrong)], float
    )


def scores(four: Float[np.ndarray, "4"], off_m: Float[np.ndarray, " n"], gated: bool = True) -> dict[str, float]:
    """Table 2, equations (36)-(40), and the position error over the test part; only the latter if not `gated`."""
    p50, p90, p95 = np.percentile(off_m, (50, 90, 95))
    place = {"error_p50_m": float(p50), "error_p90_m": float(p90), "error_p95_m": float(p95)}
    if not gated:
        return place
    tp, tn, fp, fn = four
    precision, recall = tp / max(tp + fp, 1), tp / max(tp + fn, 1)
    return {
        "tp": tp,
        "tn": tn,
        "fp": fp,
        "fn": fn,
        "accuracy": (tp + tn) / four.sum(),
        "precision": precision,
        "recall": recall,
        "f1": 2 * precision * recall / max(precision + recall, 1e-9),
        "fpr": fp / (tn + fp),
        "fnr": 1 - recall,
        "rejected_fraction": (tp + fp) / four.sum(),
        **place,
    }


def lockout_s(flagged: Bool[np.ndarray, "T L"], case: Scenario, since_s: float) -> float:
    """The longest time after `since_s` in which every range was rejected [s]."""
    came = ~np.isnan(case.error)
    rows = came.any(axis=1) & (case.log.time >= since_s)
    taken = (came & ~flagged)[rows].any(axis=1)
    times = np.concatenate([[since_s], case.log.time[rows][taken], case.log.time[rows][-1:]])
    return float(np.diff(times).max())
