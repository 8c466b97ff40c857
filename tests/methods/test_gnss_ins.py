"""A model that judges epochs: live as in a log, and to a file and back."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import jax
import numpy as np

from sensorfault.core.verdicts import FAULT
from sensorfault.logs.epochs import framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import Filter, model, monitor, navigation
from sensorfault.methods.gnss.innovation_tests import one_by_one
from sensorfault.runtime.detect import Live, detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.store import load, save
from sensorfault.simulation.train import ride


@cache
def log() -> Log:
    """The fourth satellite lies from the sixtieth second on."""
    made = ride(80.0, seed=1, noise="gaussian", imu_hz=5)
    at = made.log.index(f"{made.sky.names[3]}.corrected_m")
    made.log.value[made.log.time > 60, at] += 80.0
    return made.log


@cache
def small() -> Model:
    """Of the satellites of this log alone."""
    names = tuple(dict.fromkeys(c.sensor for c in log().channels if c.name == "corrected_m"))
    how = framing(log(), names, True)
    calibrated = monitor(how, navigation(how, Filter()), one_by_one(how, len(names), 1e-4))
    return model("innovation", log(), how, how.frame(log()), calibrated, ("w",), {})


def test_live_says_row_by_row_what_the_log_says() -> None:
    """A row that ends no epoch is answered with the last one's verdict."""
    found, live = detect(small(), log()), Live(small())
    assert found.channel[-5:, 3].tolist() == [FAULT] * 5
    columns = [c.path for c in log().channels]
    at = [columns.index(path) if path in columns else -1 for path in small().inputs]
    value = np.column_stack((log().value, np.full(len(log()), np.nan)))[:, at]
    said = [live.push(t, row) for t, row in zip(log().time, value, strict=True)]
    ends = np.searchsorted(log().time, found.log.time - 1e-9)
    np.testing.assert_array_equal([said[i].channel for i in ends], found.channel)
    np.testing.assert_array_equal([said[i].sample for i in ends], found.sample)
    assert said[ends[10] + 1] is said[ends[10]]
    assert [(e.sensor, e.start_s) for e in live.open()] == [(e.sensor, e.start_s) for e in found.events]


def test_saved_and_loaded_it_says_the_same(tmp_path: Path) -> None:
    save(small(), tmp_path / "small.sensorfault")
    again = load(tmp_path / "small.sensorfault")
    assert again.framing == small().framing
    one, other = detect(small(), log()), detect(again, log())
    np.testing.assert_array_equal(one.channel, other.channel)
    jax.tree.map(np.testing.assert_array_equal, [t.score for t in one.traces], [t.score for t in other.traces])


def test_a_page_leaves_out_satellites_that_never_rose() -> None:
    names = ("G30", *small().framing.satellites)
    how = replace(small().framing, satellites=names)
    calibrated = monitor(how, navigation(how, Filter()), one_by_one(how, len(names), 1e-4))
    epochs = how.frame(log())
    epochs.value[:9, [2, 2 + len(names)]] = np.nan  # one that rises later stays
    found = detect(model("innovation", log(), how, epochs, calibrated, ("w",), {}), epochs)
    assert len(found.log.sensors) == len(found.received.log.sensors) + 1
    assert "G30" not in [sensor.name for sensor in found.received.log.sensors]
    assert found.received.channel.shape == found.received.repaired.shape == found.received.log.value.shape
    assert found.received.sensor.shape[1] == len(found.received.log.sensors)
    np.testing.assert_array_equal(found.received.sensor[-5:, 3], FAULT)
