"""Faults in a log that was given as healthy: plain ones are named, and health is not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fitted
from sensorfault.calibration.data_screening import Suspect, isolation, leave_out
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs import read
from sensorfault.logs.table import Log
from sensorfault.methods.fit import fit
from sensorfault.simulation.road import drive

CALLED = {"spike": "spike", "offset": "offset", "frozen": "frozen"}
FAULTS = (
    Fault("spike", "gyro", "x", 10.0, 0.0, 50.0, sigmas=True),
    Fault("spike", "gyro", "x", 10.5, 0.0, -50.0, sigmas=True),
    Fault("spike", "accelerometer", "z", 20.0, 0.0, 50.0, sigmas=True),
    Fault("offset", "gyro", "z", 30.0, 5.0, 50.0, sigmas=True),
    Fault("frozen", "accelerometer", "y", 50.0, 3.0),
    Fault("offset", "accelerometer", None, 70.0, 4.0, -50.0, sigmas=True),
)


def healthy() -> Log:
    return fitted.rig().between(end_s=100.0)


def simulated() -> Log:
    return drive(200.0, seed=11).log


def said(found: tuple[Suspect, ...]) -> list[tuple[str, str]]:
    return [(suspect.channel, suspect.reason) for suspect in found]


def assert_named(log: Log, faults: tuple[Fault, ...], seed: int = 0) -> None:
    """Each channel struck is named once, from its first row to its last, with the right word; nothing else is."""
    lying = inject(log, faults, seed)
    _, found = leave_out(lying.log)
    tick = log.period_s
    wanted = []
    for fault in lying.truth:
        channels = [fault.channel] if fault.channel else ["x", "y", "z"]
        wanted += [(f"{fault.sensor}.{channel}", CALLED[fault.kind], fault) for channel in channels]
    assert sorted(said(found)) == sorted((path, word) for path, word, _ in wanted)
    for path, word, fault in wanted:
        near = [s for s in found if (s.channel, s.reason) == (path, word) and abs(s.start_s - fault.start_s) < 3 * tick]
        assert len(near) == 1
        assert abs(near[0].end_s - max(fault.end_s - tick, fault.start_s)) < 3 * tick


def test_each_kind_is_named_where_it_is() -> None:
    assert_named(healthy(), FAULTS)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: f"{fault.kind} {fault.where}")
def test_each_alone_on_a_simulated_drive(fault: Fault) -> None:
    assert_named(simulated(), (replace(fault, magnitude=2 * fault.magnitude),))


def test_an_offset_that_outlasts_the_log() -> None:
    log = healthy()
    value = log.value.copy()
    value[4000:, 2] += 50 * value[:, 2].std()
    _, found = leave_out(replace(log, value=value))
    assert said(found) == [("gyro.z", "offset")]
    assert (found[0].start_s, found[0].end_s) == (log.time[4000], log.time[-1])


@pytest.mark.parametrize("log", [healthy(), healthy().between(end_s=6.0), simulated()], ids=["rig", "spike", "road"])
def test_health_is_left_as_it_is(log: Log) -> None:
    same, found = leave_out(log)
    assert found == ()
    assert same is log


def test_the_rows_named_are_cut_out_and_no_others() -> None:
    lying = inject(healthy(), FAULTS)
    left, found = leave_out(lying.log)
    np.testing.assert_array_equal(left.time, lying.log.time[~lying.mask.any(axis=1)])
    np.testing.assert_array_equal(left.value, healthy().value[~lying.mask.any(axis=1)])
    assert [s.start_s for s in found] == sorted(s.start_s for s in found)


def test_a_bump_that_shakes_every_sensor_is_no_fault() -> None:
    log = healthy()
    value = log.value.copy()
    value[2000, :6] += 50 * value[:, :6].std(axis=0)
    assert leave_out(replace(log, value=value))[1] == ()


def test_rest_is_no_jam() -> None:
    """A wheel stands still at exactly nothing; a command stays where it was put, again and again."""
    log = healthy()
    for value_at_rest, spans in ((0.0, [1000]), (0.3, range(500, 4500, 500))):
        value = log.value.copy()
        for start in spans:
            value[start : start + 150, 4] = value_at_rest
        still = [s for s in leave_out(replace(log, value=value))[1] if s.reason == "frozen"]
        assert not still


def test_coarse_readings_that_often_repeat_are_no_jam() -> None:
    log = healthy()
    value = log.value.copy()
    value[:, 3] = np.round(value[:, 3] * 2) / 2 + 0.25
    assert leave_out(replace(log, value=value))[1] == ()


def test_repeats_that_chance_explains_are_no_jam() -> None:
    """Each measurement repeats the last with chance 0.8: a run of more than half a second is rare, not strange."""
    log = healthy()
    value = log.value.copy()
    repeats = np.random.default_rng(3).random(len(value)) < 0.8
    last_new = np.maximum.accumulate(np.where(repeats, 0, np.arange(len(value))))
    value[:, 3] = value[last_new, 3]
    runs = np.diff(np.flatnonzero(~repeats))
    assert 1 <= (runs > 25).sum() <= 5
    assert leave_out(replace(log, value=value))[1] == ()


def test_an_offset_whose_end_nobody_sees_is_not_said_to_last() -> None:
    """It fades away within three seconds: the rest of the log is healthy, and is not cut off."""
    log = healthy()
    value = log.value.copy()
    size = 50 * value[:, 2].std()
    value[3000:3200, 2] += size
    value[3200:3350, 2] += size * np.linspace(1, 0, 150)
    assert leave_out(replace(log, value=value))[1] == ()


def test_isolation_by_hand() -> None:
    """A step of 8 on one sensor where 1 is usual, while the other sensor makes one of 2."""
    step = np.ones((75, 3))
    step[::2] = -1
    step[30] = [8.0, 1.0, 2.0]
    strange = isolation(step, np.array(["a", "a", "b"]))
    np.testing.assert_allclose(strange[30], [4.0, 0.5, 2.0 / 8.0])
    np.testing.assert_allclose(strange[29], [0.5, 0.5, 1.0 / 8.0])
    np.testing.assert_allclose(strange[10], 1.0)


def test_fit_leaves_them_out_and_says_so() -> None:
    clean = fit(healthy(), "elm-autoencoder", held_out=0.0)
    lying = inject(healthy(), FAULTS)
    model = fit(lying.log, "elm-autoencoder", held_out=0.0)
    result = model.summary["training_suspects"]
    assert clean.summary["training_suspects"] == []
    assert len(result) == 8
    assert set(result[0]) == {"start_s", "end_s", "channel", "reason"}
    limit, healthy_limit = (float(m.monitor.branches[0].threshold.largest[0]) for m in (model, clean))
    assert limit == pytest.approx(healthy_limit, rel=0.2)


@pytest.mark.real
@pytest.mark.parametrize("name", ["dresden_50hz", "gnss_imu_drive0708", "comma2k19_rav4"])
@pytest.mark.parametrize("share", [0.3, 0.6, 1.0])
def test_real_drives_are_healthy(name: str, share: float, real_data: Path) -> None:
    log = read(real_data / "road" / name)
    assert leave_out(log.between(end_s=float(log.time[0]) + share * log.duration_s))[1] == ()


@pytest.mark.real
@pytest.mark.parametrize("name", ["dresden_50hz", "gnss_imu_drive0708"])
def test_a_handful_of_faults_on_a_real_drive(name: str, real_data: Path) -> None:
    log = read(real_data / "road" / name)
    start = float(log.time[0])
    learn = log.between(end_s=start + 0.6 * log.duration_s)
    wanted = tuple(replace(f, start_s=start + f.start_s, magnitude=3 * f.magnitude) for f in FAULTS if f.channel)
    assert_named(learn, wanted)
