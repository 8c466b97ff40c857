import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from faults.example import BARO, DEGREE, GYRO_X, GYRO_Z, LATITUDE, SPEED, example
from sensorfault.faults.fault import KINDS, Fault, FaultError
from sensorfault.faults.inject import Injected, inject
from sensorfault.logs.table import Log

LOG = example()
SIZE = {"spike": 4.0, "offset": -3.0, "drift": 0.7, "noise": 2.0, "scale": 1.5, "delay": 0.8}
SIZE |= {"frozen": 0.0, "missing": 0.0}


def column(fault: Fault, index: int, log: Log = LOG, seed: int = 0) -> np.ndarray:
    return inject(log, [fault], seed).log.value[:, index]


def inside(start_s: float, end_s: float) -> np.ndarray:
    return (LOG.time >= start_s) & (LOG.time < end_s)


def test_bias_adds_in_the_channels_unit() -> None:
    expected = LOG.value[:, GYRO_Z] + np.where(inside(5.0, 8.0), 2 * DEGREE, 0.0)
    np.testing.assert_array_equal(column(Fault("offset", "gyro", "z", 5.0, 3.0, 2.0), GYRO_Z), expected)


def test_sigmas_are_those_of_the_channels_measurements() -> None:
    fixes = LOG.value[3::5, SPEED]
    moved = column(Fault("offset", "gnss", "speed", 5.0, 3.0, 2.0, sigmas=True), SPEED) - LOG.value[:, SPEED]
    assert moved[60] == pytest.approx(2 * np.sqrt(np.mean((fixes - fixes.mean()) ** 2)))


def test_drift_grows_from_onset_and_is_gone_at_the_end() -> None:
    moved = column(Fault("drift", "gyro", "x", 5.0, 3.0, 0.5), GYRO_X) - LOG.value[:, GYRO_X]
    assert moved[50] == 0
    assert moved[79] == pytest.approx(0.5 * DEGREE * 2.9)
    assert not moved[80:].any()
    # The ramp began at 5.0 s, though the first fix on it is that of 5.3 s.
    fix = column(Fault("drift", "gnss", "speed", 5.0, 3.0, 3.6), SPEED)[53] - LOG.value[53, SPEED]
    assert fix == pytest.approx(0.3)


def test_jam_repeats_the_last_healthy_measurement_as_new_ones() -> None:
    done = inject(LOG, [Fault("frozen", "gnss", "speed", 5.0, 2.0)])
    # Fixes come at 4.8, 5.3, 5.8, 6.3, 6.8, 7.3 s; what was measured at 6.8 s is held until 7.3 s.
    assert set(done.log.value[53:73, SPEED]) == {LOG.value[48, SPEED]}
    assert done.log.value[73, SPEED] == LOG.value[73, SPEED]
    np.testing.assert_array_equal(done.log.fresh, LOG.fresh)
    np.testing.assert_array_equal(np.flatnonzero(done.mask[:, SPEED]), np.arange(53, 73))


def test_a_jam_from_the_first_measurement_on_repeats_that_one() -> None:
    assert set(column(Fault("frozen", "gyro", "x", 0.0, 2.0), GYRO_X)[:20]) == {LOG.value[0, GYRO_X]}


def test_miss_takes_values_and_their_repetitions_away() -> None:
    done = inject(LOG, [Fault("missing", "gnss", None, 5.0, 2.0)])
    gone = np.isnan(done.log.value[:, LATITUDE])
    np.testing.assert_array_equal(np.flatnonzero(gone[3:]) + 3, np.arange(53, 73))
    assert not done.log.fresh[53:73, [LATITUDE, SPEED]].any()
    assert done.mask[:, SPEED].sum() == 20


def test_noise_is_drawn_once_a_measurement() -> None:
    log = example(20_000)
    moved = column(Fault("noise", "gnss", "speed", 5.0, 1900.0, 3.6), SPEED, log) - log.value[:, SPEED]
    draws = moved[53:19_000:5]
    np.testing.assert_array_equal(moved[53:19_003].reshape(-1, 5), np.repeat(draws, 5).reshape(-1, 5))
    assert np.std(draws) == pytest.approx(1.0, rel=0.05)
    assert abs(np.corrcoef(draws[1:], draws[:-1])[0, 1]) < 0.06


def test_scale_multiplies() -> None:
    expected = LOG.value[:, GYRO_Z] * np.where(inside(5.0, 8.0), 0.25, 1.0)
    np.testing.assert_array_equal(column(Fault("scale", "gyro", "z", 5.0, 3.0, 0.25), GYRO_Z), expected)


def test_delay_shows_what_was_measured_before() -> None:
    late = column(Fault("delay", "gyro", "z", 5.0, 3.0, 0.4), GYRO_Z)
    np.testing.assert_array_equal(late[50:80], LOG.value[46:76, GYRO_Z])
    # 0.7 s before a fix at 5.3 s the latest was that of 4.3 s.
    assert column(Fault("delay", "gnss", "speed", 5.0, 3.0, 0.7), SPEED)[53] == LOG.value[43, SPEED]
    # Before the log there is only its first measurement.
    assert set(column(Fault("delay", "gyro", "z", 0.0, 1.0, 5.0), GYRO_Z)[:10]) == {LOG.value[0, GYRO_Z]}


def test_a_short_without_duration_strikes_one_measurement() -> None:
    done = inject(LOG, [Fault("spike", "gnss", "speed", 5.0, 0.0, 36.0)])
    moved = done.log.value[:, SPEED] - LOG.value[:, SPEED]
    np.testing.assert_allclose(moved[53:58], 10.0)
    np.testing.assert_array_equal(np.flatnonzero(np.nan_to_num(moved)), np.arange(53, 58))
    assert done.truth[0].start_s == LOG.time[53]


def test_a_longer_short_is_isolated_spikes() -> None:
    log = example(20_000)
    done = inject(log, [Fault("spike", "gyro", "x", 5.0, 1900.0, 3.0)])
    hit = np.flatnonzero(done.mask[:, GYRO_X])
    assert hit[0] == 50
    assert hit[-1] < 19_050
    assert np.diff(hit).min() >= 2
    assert np.diff(hit).mean() == pytest.approx(10, rel=0.05)
    np.testing.assert_allclose((done.log.value - log.value)[hit, GYRO_X], 3 * DEGREE)


def test_faults_on_one_channel_act_by_onset() -> None:
    bias, scale = Fault("offset", "gyro", "z", 5.0, 4.0, 1.0), Fault("scale", "gyro", "z", 6.0, 1.0, 3.0)
    done = inject(LOG, [scale, bias]).log.value[:, GYRO_Z]
    assert done[55] == pytest.approx(LOG.value[55, GYRO_Z] + DEGREE)
    assert done[65] == pytest.approx((LOG.value[65, GYRO_Z] + DEGREE) * 3)
    assert [fault.kind for fault in inject(LOG, [scale, bias]).truth] == ["offset", "scale"]


def test_what_runs_past_the_log_is_clipped_in_the_truth() -> None:
    (done,) = inject(LOG, [Fault("offset", "gyro", "z", 18.0, 60.0, 1.0)]).truth
    assert done.end_s == pytest.approx(LOG.time[-1])
    inner = Fault("offset", "gyro", "z", 0.7, 0.1, 1.0)
    assert inject(LOG, [inner]).truth == (inner,)


def test_the_seed_decides() -> None:
    fault = Fault("noise", "gyro", "z", 5.0, 3.0, 1.0)
    np.testing.assert_array_equal(column(fault, GYRO_Z, seed=3), column(fault, GYRO_Z, seed=3))
    assert (column(fault, GYRO_Z, seed=3) != column(fault, GYRO_Z, seed=4))[50:80].all()
    both = inject(LOG, [Fault("noise", "gyro", None, 5.0, 3.0, 1.0)]).log.value - LOG.value
    assert (both[50:80, GYRO_X] != both[50:80, GYRO_Z]).all()


@st.composite
def some_faults(draw: st.DrawFn) -> list[Fault]:
    def one() -> Fault:
        kind = draw(st.sampled_from(KINDS))
        sensor, channel = draw(
            st.sampled_from([("gyro", "x"), ("gyro", None), ("gnss", "speed"), ("gnss", None), ("baro", "pressure")])
        )
        start, duration = draw(st.integers(0, 150)) / 10, draw(st.integers(6, 80)) / 10
        return Fault(kind, sensor, channel, start, duration, SIZE[kind])

    return [one() for _ in range(draw(st.integers(1, 4)))]


def attempt(faults: list[Fault]) -> tuple[Injected | None, str]:
    try:
        return inject(LOG, faults, seed=1), ""
    except FaultError as error:
        return None, str(error)


@settings(max_examples=80, deadline=None)
@given(some_faults(), st.randoms(use_true_random=False))
def test_laws_of_injection(faults: list[Fault], shuffler) -> None:
    before = example()
    done, refusal = attempt(faults)
    if done is None:  # an earlier miss left a later fault nothing to strike
        assert "has no measurement" in refusal
        assert any(fault.kind == "missing" for fault in faults)
        return
    # The log given stays as it was.
    np.testing.assert_array_equal(LOG.value, before.value)
    np.testing.assert_array_equal(LOG.fresh, before.fresh)
    # Outside the mask nothing changed, to the bit.
    assert done.log.value[~done.mask].tobytes() == LOG.value[~done.mask].tobytes()
    assert (done.log.fresh == LOG.fresh)[~done.mask].all()
    # A new measurement has a value, and none is invented.
    assert np.isfinite(done.log.value[done.log.fresh]).all()
    assert (LOG.fresh | ~done.log.fresh).all()
    # A row repeats what became of the measurement it repeats.
    for c in (LATITUDE, SPEED):
        for t in range(4, len(LOG)):
            if not LOG.fresh[t, c]:
                assert done.log.value[t, c].tobytes() == done.log.value[t - 1, c].tobytes()
    assert np.isnan(done.log.value[~LOG.fresh[:, BARO], BARO]).all()
    # The order in which they are given does not matter.
    shuffled = list(faults)
    shuffler.shuffle(shuffled)
    again = inject(LOG, shuffled, seed=1)
    assert again.log.value.tobytes() == done.log.value.tobytes()
    assert again.truth == done.truth
    # A sensor's numbers do not depend on what is done to the others.
    for sensor in {fault.sensor for fault in faults}:
        alone = inject(LOG, [fault for fault in faults if fault.sensor == sensor], seed=1)
        columns = LOG.of(sensor)
        assert alone.log.value[:, columns].tobytes() == done.log.value[:, columns].tobytes()


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        (Fault("melt", "gyro", "z", 5.0, 1.0, 1.0), "kind 'melt' is unknown"),
        (Fault("offset", "gyrr", "z", 5.0, 1.0, 1.0), "no sensor is called 'gyrr'; take one of gyro, gnss, baro"),
        (Fault("offset", "gyro", "q", 5.0, 1.0, 1.0), "no channel 'q'; take one of x, z"),
        (Fault("offset", "gyro", "z", -1.0, 3.0, 1.0), "lies outside the log; choose one from 0 to 19.9 s"),
        (Fault("offset", "gyro", "z", 20.0, 3.0, 1.0), "lies outside the log"),
        (Fault("offset", "gyro", "z", 5.0, -3.0, 1.0), "is negative"),
        (Fault("offset", "gyro", "z", 5.0, 0.0, 1.0), "only a spike may last 0 s"),
        (Fault("offset", "gyro", "z", 5.0, 1.0), "magnitude is missing"),
        (Fault("offset", "gyro", "z", 5.0, 1.0, float("nan")), "finite"),
        (Fault("noise", "gyro", "z", 5.0, 1.0, -1.0), "give a positive one"),
        (Fault("scale", "gyro", "z", 5.0, 1.0, 1.0), "a factor of 1"),
        (Fault("scale", "gyro", "z", 5.0, 1.0, 2.0, sigmas=True), "cannot be in sigmas"),
        (Fault("offset", "gnss", "speed", 5.4, 0.2, 1.0), "has no measurement from 5.4 to 5.6 s"),
    ],
)
def test_a_fault_that_cannot_be_is_refused_in_a_sentence(fault: Fault, sentence: str) -> None:
    with pytest.raises(FaultError) as caught:
        inject(LOG, [fault])
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_constant_channel_has_no_sigma() -> None:
    value = LOG.value.copy()
    value[:, GYRO_X] = 1.0
    flat = Log(LOG.time, value, LOG.fresh, LOG.channels, LOG.sensors)
    with pytest.raises(FaultError, match="never changes"):
        inject(flat, [Fault("offset", "gyro", "x", 5.0, 1.0, 2.0, sigmas=True)])
