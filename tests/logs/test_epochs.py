"""A log becomes epochs: which rows, which satellites, what of it is missing; all at once and row by row."""

from dataclasses import replace

import jax
import numpy as np
import pytest

from sensorfault.logs.epochs import Framing, Gather, framing
from sensorfault.logs.table import Channel, Log, LogError, Sensor

TOLD = ("corrected_m", "doppler_hz", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "cn0_dbhz")
INERTIAL = tuple(f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz")
EVERY = 4  # rows an epoch


def log(rows: int = 18) -> Log:
    """Ten rows a second; after rows 1, 5, 9 and so on two satellites are heard, G02 from the second time on."""
    value = np.full((rows, 7 + 2 * len(TOLD)), np.nan)
    value[:, :7] = np.arange(rows)[:, None] + np.arange(7) / 10
    value[1::EVERY, 7:16] = 100.0 + np.arange(rows)[1::EVERY, None] + np.arange(9)
    value[1 + EVERY :: EVERY, 16:] = 200.0 + np.arange(rows)[1 + EVERY :: EVERY, None] + np.arange(9)
    inertial = [Channel(path.split(".")[1], path.split(".")[0], "") for path in INERTIAL]
    result = [Channel(name, one, "") for one in ("G01", "G02") for name in TOLD]
    channels = (*inertial, Channel("speed", "wheel", "m/s"), *result)
    sensors = tuple(Sensor(name, 0.1) for name in dict.fromkeys(channel.sensor for channel in channels))
    return Log(np.arange(rows) / 10, value, np.isfinite(value), channels, sensors, "hand")


def how(rates: bool = True, wheel: str = "wheel.speed") -> Framing:
    return framing(log(), ("G01", "G02", "G09"), rates, wheel)


def test_how_a_log_becomes_epochs() -> None:
    own = how()
    assert own.rows == EVERY + 2
    assert own.tick_s == pytest.approx(0.1)
    assert own.period_s == pytest.approx(0.4)
    assert own.inertial == INERTIAL
    assert [channel.path for channel in own.channels[:4]] == [
        "G01.corrected_m",
        "G02.corrected_m",
        "G09.corrected_m",
        "G01.doppler_hz",
    ]


def test_an_epoch_ends_with_a_new_pseudorange() -> None:
    epochs = how().frame(log())
    np.testing.assert_allclose(epochs.time, [0.1, 0.5, 0.9, 1.3, 1.7])
    np.testing.assert_array_equal(epochs.value[1], [105.0, 205.0, np.nan, 106.0, 206.0, np.nan])
    np.testing.assert_array_equal(epochs.fresh[0], [True, False, False, True, False, False])
    block = epochs.block
    np.testing.assert_array_equal(block.place[1], [[107, 108, 109], [207, 208, 209], [np.nan] * 3])
    np.testing.assert_array_equal(block.speed[1, 0], [110, 111, 112])
    np.testing.assert_array_equal(block.cn0[1], [113, 213, np.nan])
    np.testing.assert_array_equal(block.ahead, np.arange(18)[1::EVERY] + 0.6)


def test_a_doppler_of_another_frequency_is_none() -> None:
    mixed = log()
    names = [replace(channel, sensor=channel.sensor.replace("G02", "C02")) for channel in mixed.channels]
    mixed = replace(mixed, channels=tuple(names))
    epochs = framing(mixed, ("G01", "C02"), True, "wheel.speed").frame(mixed)
    np.testing.assert_array_equal(epochs.value[1], [105.0, 205.0, 106.0, np.nan])
    assert not epochs.fresh[:, 3].any()
    assert np.isfinite(mixed.value[5, 16:]).all()  # the log itself keeps it


def test_the_rows_between_are_its_own() -> None:
    block = how().frame(log()).block
    np.testing.assert_allclose(block.dt[0], [0.0, 0.1, 0, 0, 0, 0])  # of the first row nobody knows how long it was
    np.testing.assert_allclose(block.dt[1], [0.1] * 4 + [0, 0])
    np.testing.assert_array_equal(block.gyro[1, :4, 0], [2, 3, 4, 5])
    np.testing.assert_allclose(block.force[1, :4, 2], np.array([2, 3, 4, 5]) + 0.5)
    np.testing.assert_array_equal(block.ok[1], [True] * 4 + [False] * 2)


def test_holes_are_not_believed_and_take_their_time() -> None:
    whole = log()
    value = whole.value.copy()
    value[3, 4] = np.nan
    late = np.where(np.arange(18) >= 7, 2.0, 0.0)
    block = how().frame(replace(whole, value=value, time=whole.time + late)).block
    np.testing.assert_array_equal(block.ok[1, :4], [True, False, True, True])
    np.testing.assert_array_equal(block.gyro[1, 1], [0, 0, 0])
    assert block.dt[1, 1] == pytest.approx(0.1)
    np.testing.assert_array_equal(block.ok[2, :4], [True, False, True, True])
    assert block.dt[2, 1] == pytest.approx(2.1)


def test_without_satellites_an_epoch_ends_with_the_last_row_there_is_room_for() -> None:
    silent = log()
    value = silent.value.copy()
    value[2:14, 7:] = np.nan
    epochs = how().frame(replace(silent, value=value, fresh=np.isfinite(value)))
    np.testing.assert_allclose(epochs.time, [0.1, 0.7, 1.3, 1.7])
    assert not epochs.fresh[1:3].any()


def test_held_values_are_no_epoch() -> None:
    held = log()
    fresh = held.fresh.copy()
    fresh[5, 7:] = False
    np.testing.assert_allclose(how().frame(replace(held, fresh=fresh)).time, [0.1, 0.7, 0.9, 1.3, 1.7])


def test_no_inertial_unit_and_no_wheels() -> None:
    bare = log().select([channel.path for channel in log().channels[7:]])
    own = framing(bare, ("G01", "G02"), False)
    assert own.inertial == ()
    block = own.frame(bare).block
    assert not block.ok.any()
    assert np.isnan(block.ahead).all()
    assert block.dt[1].sum() == pytest.approx(0.4)


def test_row_by_row_it_is_the_same() -> None:
    own, whole = how(), log()
    at = [channel.path for channel in whole.channels]
    column = [at.index(path) if path in at else -1 for path in own.inputs]
    value = np.column_stack((whole.value, np.full(len(whole), np.nan)))[:, column]
    gather = Gather(own)
    cuts = [gather.push(t, row, np.ones(len(row), bool)) for t, row in zip(whole.time, value, strict=True)]
    result = [cut for cut in cuts if cut is not None]
    epochs = own.frame(whole)
    np.testing.assert_array_equal(np.concatenate([cut.time for cut in result]), epochs.time)
    np.testing.assert_array_equal(np.concatenate([cut.value for cut in result]), epochs.value)
    np.testing.assert_array_equal(np.concatenate([cut.fresh for cut in result]), epochs.fresh)
    together = jax.tree.map(lambda *parts: np.concatenate(parts), *(cut.epoch for cut in result))
    jax.tree.map(np.testing.assert_array_equal, together, epochs.block)


def test_one_epoch_of_nothing_has_the_shape_of_any() -> None:
    own = how()
    some = jax.tree.map(lambda x: x[0].shape, own.frame(log()).block)
    assert jax.tree.map(np.shape, own.nothing) == some


@pytest.mark.parametrize("gone", ["gyro.y", "wheel.speed"])
def test_what_the_log_lacks_is_said(gone: str) -> None:
    poor = log().select([channel.path for channel in log().channels if channel.path != gone])
    with pytest.raises(LogError, match=rf"^hand has no {gone}, which [^\n]*\.$"):
        how().frame(poor)


def test_no_satellite_is_said() -> None:
    with pytest.raises(LogError, match=r"^hand has no corrected pseudorange of a satellite, which [^\n]*\.$"):
        how().frame(log().select([*INERTIAL, "wheel.speed"]))
    with pytest.raises(LogError, match=r"^hand has 1 epochs with a pseudorange; give a longer part of it\.$"):
        framing(log(3), ("G01",), False)
