"""Predictors of the position."""

import functools

import numpy as np

from laws.case import Case
from laws.drives import IMU, POSITION, drive
from sensorfault.methods.catalog import METHODS
from sensorfault.methods.position import ar_predictor, lstm_displacement, lstm_predictor, mlp_predictor
from sensorfault.methods.position.predicted import READMIT_S, REBUILD_S
from sensorfault.runtime.runners import samples
from sensorfault.training.gradient import Plan
from sensorfault.training.session import Session

PLAN = Plan(epochs=3, batch=256)
PREDICTORS = {
    "lstm-predictor": functools.partial(lstm_predictor.build, size=lstm_predictor.Size(10, (4, 4), PLAN)),
    "lstm-displacement": functools.partial(lstm_displacement.build, size=lstm_displacement.Size((4, 4), PLAN)),
    "mlp-predictor": functools.partial(mlp_predictor.build, size=mlp_predictor.Size(10, (8,), PLAN)),
    "ar-predictor": functools.partial(ar_predictor.build, length=10),
    "persistence": METHODS["persistence"].build,
    "linear-extrapolation": METHODS["linear-extrapolation"].build,
}


def predictor(name: str) -> Case:
    """A predictor of the position, small and hardly trained, on a part of its own drive, since a network knows no place
    that it has never seen.
    """
    log = drive(120.0).select([*IMU, *POSITION])
    part = log.between(78.0, 94.0)
    rows = samples(part.time, part.value, part.fresh)
    lie = np.where(np.arange(8) >= 6, 40 * log.value.std(axis=0), 0.0)
    back_s = REBUILD_S + READMIT_S + 2.5
    lost = {6: (7,), 7: (6,)} if name == "lstm-displacement" else {}  # half a position is none
    return Case(name, PREDICTORS[name](log, 0, Session()).monitor, rows, lie, back_s, named=(6, 7), lost=lost)


CASES = {name: functools.partial(predictor, name) for name in PREDICTORS}
