"""Open-loop scores: a monitor with its limits off, replayed over healthy data."""

from dataclasses import replace
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.core.types import Report, Residual, Sample
from sensorfault.logs.table import Log
from sensorfault.runtime.replay import Replayed, replay_keeping, replay_log
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.threshold.off import Off


def uncalibrated(monitor: Monitor) -> Monitor:
    """The monitor with all its limits off. It accuses nobody, so nothing is judged again.

    Monitors that differ in their limits alone become one, so they share one compiled program.
    """
    return replace(monitor, branches=tuple(replace(branch, threshold=Off()) for branch in monitor.branches), most=0)


def open_loop(monitor: Monitor, log: Log) -> Replayed:
    """The monitor with its limits off, over a log."""
    return replay_log(uncalibrated(monitor), log)


def open_loop_scores(monitor: Monitor, log: Log) -> tuple[Float[np.ndarray, "T K"], ...]:
    """The scores of every branch with the limits off; NaN where nothing was tested."""
    return tuple(np.asarray(score) for score in open_loop(monitor, log).scores)


def extra_tape(residual: Stage[Any, Sample, Residual, Any], log: Log) -> Any:
    """`extra` of a residual generator for every sample of a healthy log; all samples are trusted."""
    channels = len(log.channels)
    silent = Branch(Norm(jnp.ones(channels)), Off())
    monitor = Monitor(residual, (silent,), Exceed(), Drop(), jnp.zeros(channels), tuple(range(channels)))
    return replay_keeping(_extra, monitor, monitor.init(), log)[1]


def _extra(report: Report) -> Any:
    return report.residual.extra
