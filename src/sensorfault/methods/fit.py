"""Fit a model on healthy data, and count its false alarms on the part of the data that was held out."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Literal, overload

from sensorfault.calibration.data_screening import leave_out
from sensorfault.core.expect import LOG, expect
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.catalog import DEFAULT, recipe
from sensorfault.numerics.poisson import rate_below
from sensorfault.relations.events import METHOD as AUTO
from sensorfault.runtime.compared import Comparison, NothingToCompare, comparison_of
from sensorfault.runtime.described import described
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.names import is_default, recipe_of, vehicle_of
from sensorfault.training.session import Session

HELD_OUT = 0.3


@overload
def fit(  # type: ignore[overload-overlap]
    log: Log,
    method: Literal["auto", "car", "drone", "underwater", "rail"] = "auto",
    held_out: float = HELD_OUT,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    checkpoint: Path | None = None,
) -> Model | Comparison: ...


@overload
def fit(
    log: Log,
    method: str,
    held_out: float = HELD_OUT,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    checkpoint: Path | None = None,
) -> Model: ...


def fit(
    log: Log,
    method: str = AUTO,
    held_out: float = HELD_OUT,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
    checkpoint: Path | None = None,
) -> Model | Comparison:
    """Fit a method of the catalog on a healthy log.

    The last share `held_out` of the log (0 to 0.9) is not used for the fit; the model is tested on it afterwards, and
    `model.summary` has `held_out_s`, `held_out_alarms`, `alarms_per_hour` and its upper 95 % bound,
    `alarms_per_hour_below`. With `held_out` 0 the whole log is used and the rate is not measured. Stretches of the
    training part that clearly look faulty are removed and listed in `training_suspects` (start_s, end_s, channel,
    reason).

    `progress` is called with a few words on the current step. `checkpoint`: a file saved after every epoch of a
    training; resumed if present.

    Args:
        log: T rows, C channels in SI on one clock, taken as healthy.
        method: "auto", which compares the sensors with each other and uses the whole log (where no two measure the
            same, it is relative-conditioning); "car", "drone", "underwater" or "rail", which are the same for a
            vehicle of that class; "imu", "arm", or a name of `METHODS`.
        held_out: share of the log.
        seed: of all chance in the fit; the same seed gives the same model.
        progress: called with a sentence.
        checkpoint: a file.

    Raises:
        LogError: the method is unknown, cannot be fitted on this log, or the checkpoint is of another fit.
        TypeError: something else than a log, or than the name of a method.
    """
    expect(log, Log, "fit: log", LOG)
    expect(method, str, "fit: method", "the name of one: auto, or one of sf.METHODS")
    if not 0 <= held_out <= 0.9:
        raise LogError(f"held_out is {held_out:g}; give the share of the log to hold out for testing, 0 to 0.9.")
    if len(log) < 2:
        raise LogError(f"{log.name} has {len(log)} rows; give a log of at least a few seconds.")
    if is_default(method):
        try:
            return comparison_of(log, vehicle=vehicle_of(method))
        except NothingToCompare:
            method = DEFAULT
    method = recipe_of(method)
    log = log.measurements()
    session = Session(progress, checkpoint) if progress else Session(checkpoint=checkpoint)
    cut = float(log.time[0]) + (1 - held_out) * log.duration_s
    session.progress(f"fitting {method}")
    unseen = log.between(cut)
    if held_out and len(unseen) < 2:
        raise LogError(f"held_out is {held_out:g}, which leaves fewer than two rows of {log.name}; give more, or 0.")
    training, suspects = leave_out(log.between(end_s=cut) if held_out else log)
    model = recipe(method).build(training, seed, session)
    left_out = [suspect.as_dict() for suspect in suspects]
    summary = model.summary | described(log) | {"seed": seed, "training_suspects": left_out}
    if held_out:
        session.progress("testing on the held-out part")
        alarms = len(detect(model, unseen).events)
        hours = unseen.duration_s / 3600
        summary |= {"held_out_s": unseen.duration_s, "held_out_alarms": alarms, "alarms_per_hour": alarms / hours}
        summary |= {"alarms_per_hour_below": rate_below(alarms, hours)}
    return replace(model, summary=summary)
