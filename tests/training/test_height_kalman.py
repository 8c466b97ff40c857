"""Noise of the height's filter: as large as its innovations say, whatever the flight has besides the height."""

from dataclasses import replace

import numpy as np
import pytest

import flown
from sensorfault.logs.table import Log
from sensorfault.simulation.flapping_wing import fly
from sensorfault.training.height_kalman import fit_height_kalman, normalised
from sensorfault.vehicles.fixed_wing import Roles, roles

FLIGHT = flown.flight()


@pytest.mark.parametrize(
    ("log", "outputs"),
    [(FLIGHT, 3), (FLIGHT.select(["gnss.altitude", "barometer.altitude"]), 2), (FLIGHT.select(["gnss.altitude"]), 1)],
    ids=["all", "heights", "height"],
)
def test_innovations_are_as_large_as_it_says(log: Log, outputs: int) -> None:
    filter = fit_height_kalman(log, 0, roles(log))
    assert len(filter.outputs) == outputs
    assert filter.inertial == ()
    z = normalised(filter, log)
    assert np.nanmean(z**2) == pytest.approx(1.0, abs=1e-6)
    assert np.isfinite(z).mean() > 0.95


def test_an_inertial_unit_is_taken_as_it_is_mounted() -> None:
    """With y left and z up, or with y right and z down: the same filter says the same."""
    log = fly(60.0, seed=1, beat_hz=0.0).log
    found = roles(log)
    turned = replace(log, value=log.value.copy())
    turned.value[:, list(found.accelerometer or ())[1:]] *= -1
    one, two = (fit_height_kalman(each, found.height or 0, found) for each in (log, turned))
    assert (float(one.below), float(two.below)) == (-1.0, 1.0)
    assert one.inertial == found.unit
    np.testing.assert_allclose(normalised(one, log), normalised(two, turned), rtol=1e-9)
    without = fit_height_kalman(log, found.height or 0, replace(found, roll=None))
    assert without.inertial == ()


def test_a_barometer_alone_is_no_reference_to_itself() -> None:
    log = FLIGHT.select(["barometer.altitude", "gnss.down"])
    found = roles(log)
    assert found == Roles(barometric=0, vertical=1, upward=-1.0)
    filter = fit_height_kalman(log, 0, found)
    assert filter.outputs == (0, 1)
    np.testing.assert_array_equal(np.asarray(filter.rows), [[1, 0, 0, 0], [0, -1, 0, 0]])
