"""Healthy data in, fitted model out, with what the model does on healthy data it has not seen."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from sensorfault.calibration.data_screening import leave_out
from sensorfault.core.expect import LOG, expect
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.catalog import DEFAULT, recipe
from sensorfault.numerics.poisson import rate_below
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session

HELD_OUT = 0.3


def fit(
    log: Log,
    method: str = DEFAULT,
    held_out: float = HELD_OUT,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    checkpoint: Path | None = None,
) -> Model:
    """Fit a method of the catalog on a healthy log.

    The last `held_out` share of the log (0 to 0.9) is kept from the fit and judged afterwards: `model.summary` then has
    `held_out_s`, `held_out_alarms`, `alarms_per_hour` and, with 95 % confidence, `alarms_per_hour_below`. With 0 all is
    used and nothing is known of the rate. What plainly looks faulty in the part to fit on is left out and named in
    `training_suspects`, a list of start_s, end_s, channel and reason.

    `progress` is told what is being done. `checkpoint`: a file that a training by epochs writes after each, and goes on
    from if it is there.

    Args:
        log: T rows, C channels in SI on one clock, taken as healthy.
        method: a name of `METHODS`.
        held_out: share of the log.
        seed: of all chance in the fit; the same seed gives the same model.
        progress: called with a sentence.
        checkpoint: a file.

    Raises:
        LogError: an unknown method, a log that it cannot be fitted on, or a checkpoint of another fit.
        TypeError: something else than a log, or than the name of a method.
    """
    expect(log, Log, "fit: log", LOG)
    expect(method, str, "fit: method", "the name of one, as in sf.METHODS")
    if not 0 <= held_out <= 0.9:
        raise LogError(f"held_out is {held_out:g}; give the share of the log to keep for judging, 0 to 0.9.")
    if len(log) < 2:
        raise LogError(f"{log.name} has {len(log)} rows; give a log of at least a few seconds.")
    session = Session(progress, checkpoint) if progress else Session(checkpoint=checkpoint)
    cut = float(log.time[0]) + (1 - held_out) * log.duration_s
    session.tell(f"fitting {method}")
    unseen = log.between(cut)
    if held_out and len(unseen) < 2:
        raise LogError(f"held_out is {held_out:g}, which keeps no two rows of {log.name} to judge; give more, or 0.")
    training, suspects = leave_out(log.between(end_s=cut) if held_out else log)
    model = recipe(method).build(training, seed, session)
    summary = model.summary | {"seed": seed, "training_suspects": [suspect.as_dict() for suspect in suspects]}
    if held_out:
        session.tell("judging the part held out")
        alarms = len(detect(model, unseen).events)
        hours = unseen.duration_s / 3600
        summary |= {"held_out_s": unseen.duration_s, "held_out_alarms": alarms, "alarms_per_hour": alarms / hours}
        summary |= {"alarms_per_hour_below": rate_below(alarms, hours)}
    return replace(model, summary=summary)
