"""`train` as a user has it: fitted on one ride, asked about another, with a satellite that lies."""

from dataclasses import replace

import numpy as np
import pytest

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.epochs import RANGE
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.fit import fit
from sensorfault.methods.gnss import needs
from sensorfault.methods.gnss.satellite_bank import RECIPE
from sensorfault.runtime.detect import detect
from sensorfault.simulation.train import ride
from sensorfault.training.session import Session

pytestmark = pytest.mark.usefixtures("hasty")


def small(log: Log) -> Log:
    """Pseudoranges alone, of a system that has ten satellites: less to compile."""
    kept = log.select([channel.path for channel in log.channels if channel.name != "doppler_hz"])
    names = [sensor.name for sensor in kept.sensors if sensor.name[0] == "G"]
    called = {name: f"G{i + 1:02d}" for i, name in enumerate(names)}
    return replace(
        kept,
        channels=tuple(replace(one, sensor=called.get(one.sensor, one.sensor)) for one in kept.channels),
        sensors=tuple(replace(one, name=called.get(one.name, one.name)) for one in kept.sensors),
    )


@pytest.fixture(autouse=True)
def _ten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(needs.SYSTEMS, "G", 10)


def test_a_satellite_that_lies_is_named_and_nobody_else() -> None:
    model = fit(small(ride(110.0, 3, imu_hz=10).log), "satellite-bank", held_out=0.0)
    assert model.monitor.residual.bank
    at_once, later = model.summary["smallest_step_m"].values()
    assert 5.0 < later < at_once < 100.0
    assert model.summary["noise_factor"] == pytest.approx(0.85, abs=0.25)

    log = small(ride(110.0, 4, imu_hz=10).log)
    calibrated = [i for i, channel in enumerate(log.channels) if channel.name == RANGE]
    steady = log.channels[max(calibrated, key=lambda i: int(log.fresh[:, i].sum()))].sensor
    assert detect(model, log).events == ()
    done = inject(log, [Fault("offset", steady, RANGE, 50.0, 40.0, 3 * at_once)], 0)
    (event,) = detect(model, done.log).events
    assert event.sensor == steady
    assert event.start_s == pytest.approx(50.0, abs=1.0)


def test_what_it_needs_is_said_in_one_sentence() -> None:
    log = small(ride(30.0, 3, imu_hz=10).log)
    with pytest.raises(
        LogError, match=r"has 30 epochs with 4 satellites, but satellite-bank needs 60; give a longer log\.$"
    ):
        RECIPE.build(log, 0, Session())
    empty = replace(log, value=np.where(True, np.nan, log.value), fresh=log.fresh & False)
    assert "satellite-bank needs" in RECIPE.lacks(log)
    assert RECIPE.lacks(empty)
