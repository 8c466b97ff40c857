import time

import numpy as np
import pytest

from sensorfault.simulation import imu
from sensorfault.simulation.road import Simulated, drive

DEGREE = np.pi / 180
GYRO, FORCE, FIX = slice(0, 3), slice(3, 6), slice(6, 11)


@pytest.fixture(scope="module")
def drives() -> list[Simulated]:
    return [drive(600.0, seed) for seed in range(3)]


def test_the_car_obeys_comfort_and_the_law(drives: list[Simulated]) -> None:
    for simulated in drives:
        speed = simulated.motion.speed
        forward, left, up = simulated.motion.acceleration.T
        assert speed.min() >= 0
        assert speed.max() < 70 / 3.6
        assert np.abs(forward).max() < 2.0
        assert np.abs(left).max() < 4.0
        assert np.abs(up).max() < 1.0
        assert np.abs(np.diff(forward) * 50).max() < 5.0
        standing = speed == 0
        # It stands at the start, and some of the rest of the time.
        assert standing[:200].all()
        assert 0.03 < standing[500:].mean() < 0.5
        assert 3000 < np.linalg.norm(np.diff(simulated.motion.position, axis=0), axis=1).sum() < 8000


def test_it_turns_both_ways(drives: list[Simulated]) -> None:
    rates = np.concatenate([np.gradient(s.motion.heading, s.motion.time) for s in drives])
    assert rates.max() > 20 * DEGREE
    assert rates.min() < -20 * DEGREE
    turning = rates[np.abs(rates) > 5 * DEGREE]
    assert 0.3 < np.mean(turning > 0) < 0.7


def test_rates_and_forces_integrate_to_the_motion() -> None:
    """A strapdown by rotation matrices, which knows nothing of how the truth was made."""
    simulated = drive(120.0, seed=4, imu_hz=200.0)
    m = simulated.motion
    rate, force, dt = imu.angular_rate(m), imu.specific_force(m), 1 / 200
    up, nose = m.pitch[0], m.heading[0]
    cy, sy, cp, sp = np.cos(nose), np.sin(nose), np.cos(up), np.sin(up)
    attitude = np.array([[cy * cp, -sy, cy * sp], [sy * cp, cy, sy * sp], [-sp, 0.0, cp]])
    velocity, track = np.zeros(3), []
    for w, f in zip((rate[1:] + rate[:-1]) / 2, (force[1:] + force[:-1]) / 2, strict=True):
        angle = np.linalg.norm(w) * dt
        axis = w / max(np.linalg.norm(w), 1e-12)
        k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])

        def turn(a: float, k: np.ndarray = k) -> np.ndarray:
            return np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * k @ k

        velocity = velocity + attitude @ turn(angle / 2) @ f * dt - np.array([0, 0, 9.81]) * dt
        attitude = attitude @ turn(angle)
        track.append(velocity)
    error = np.array(track) - m.velocity[1:]
    assert m.speed.max() > 10
    assert np.abs(error).max() < 0.02


def test_the_log_is_like_a_real_one(drives: list[Simulated]) -> None:
    log = drives[0].log
    assert [c.path for c in log.channels[:6]] == [f"{s}.{a}" for s in ("gyro", "accelerometer") for a in "xyz"]
    assert len(log) == 30_000
    assert np.isfinite(log.value).all()
    assert log.fresh[:, :6].all()
    gnss = log.sensors[2]
    assert gnss.held
    # Held means repeated to the bit; fixes come at 10 Hz, sometimes up to 0.7 s late.
    held = ~log.fresh[1:, 6]
    np.testing.assert_array_equal(log.value[1:, FIX][held], log.value[:-1, FIX][held])
    assert (log.fresh[:, FIX] == log.fresh[:, [6]]).all()
    gaps = np.diff(log.time[log.fresh[:, 6]])
    assert np.median(gaps) == pytest.approx(0.1)
    assert 0.29 < gaps.max() < 0.75


def test_levels_are_near_those_of_a_real_drive(drives: list[Simulated]) -> None:
    # Standard deviations over 216 s in Dresden at 50 Hz (balzer82/Kalman): roll, pitch, yaw rate [°/s], ax, ay, az.
    real = np.array([2.54, 4.71, 8.99, 1.83, 1.09, 1.38])
    for simulated in drives:
        ours = simulated.log.value[:, :6].std(axis=0) / np.array([DEGREE, DEGREE, DEGREE, 1.0, 1.0, 1.0])
        assert (ours > real / 2).all()
        assert (ours < real * 2).all()


def test_sensors_err_as_their_grade_says() -> None:
    errors = [d.log.value[:, :6] - d.truth.value[:, :6] for d in (drive(60.0, seed) for seed in range(30))]
    bias = np.array([e.mean(axis=0) for e in errors])
    white = np.array([np.diff(e, axis=0).std(axis=0) / np.sqrt(2) for e in errors])
    assert np.sqrt(np.mean(bias[:, GYRO] ** 2)) == pytest.approx(0.5 * DEGREE, rel=0.25)
    assert np.sqrt(np.mean(bias[:, FORCE] ** 2)) == pytest.approx(0.15, rel=0.25)
    # 0.007 °/s/√Hz and 180 µg/√Hz at 50 Hz.
    assert np.median(white[:, GYRO]) == pytest.approx(0.0495 * DEGREE, rel=0.05)
    assert np.median(white[:, FORCE]) == pytest.approx(0.0125, rel=0.08)


def test_fixes_are_metres_off_and_freeze_their_course(drives: list[Simulated]) -> None:
    metres = np.array([6371e3, 6371e3 * np.cos(51.05 * DEGREE), 1.0])
    off = np.concatenate([(d.log.value - d.truth.value)[d.log.fresh[:, 6], 6:9] * metres for d in drives])
    spread = np.sqrt((off**2).mean(axis=0))
    assert (spread > [0.6, 0.6, 1.2]).all()
    assert (spread < [2.4, 2.4, 5.0]).all()
    for d in drives:
        step = np.diff((d.log.value - d.truth.value)[d.log.fresh[:, 6], 6:9] * metres, axis=0)
        assert np.median(np.abs(step)) < 0.15
        assert np.abs(step).max() < 2.0
        standing = d.motion.speed == 0
        assert len(np.unique(d.log.value[:200, 10])) == 1
        assert d.log.value[standing, 9].max() < 0.4
        # The course is that of half a second before: 25 rows.
        driving = np.flatnonzero(d.log.fresh[:, 10] & (d.motion.speed > 5) & (d.log.time > 1))
        lag = d.log.value[driving, 10] - d.truth.value[driving - 25, 10]
        assert np.abs(np.angle(np.exp(1j * lag))).max() < 5 * DEGREE


def test_true_positions_and_courses_are_those_of_the_true_velocity(drives: list[Simulated]) -> None:
    d = drives[0]
    north = np.diff(d.truth.value[:, 6]) * 6.3916e6 * 50  # meridian radius at 51° [m], plus height
    np.testing.assert_allclose(north, d.motion.velocity[1:, 1], atol=0.25)
    east, north = d.motion.velocity[d.motion.speed > 1, :2].T
    off = d.truth.value[d.motion.speed > 1, 10] - np.arctan2(east, north)
    np.testing.assert_allclose(np.exp(1j * off), 1.0, atol=1e-9)


def test_the_seed_decides_and_sensors_do_not_change_the_road() -> None:
    one, same, other = drive(30.0, 1), drive(30.0, 1), drive(30.0, 2)
    assert one.log.value.tobytes() == same.log.value.tobytes()
    assert (one.log.value != other.log.value).any()
    slower = drive(30.0, 1, gnss_hz=5.0)
    np.testing.assert_array_equal(slower.motion.position, one.motion.position)
    np.testing.assert_array_equal(slower.log.value[:, :6], one.log.value[:, :6])


def test_ten_minutes_take_less_than_a_second() -> None:
    begin = time.process_time()
    drive()
    assert time.process_time() - begin < 1.0


@pytest.mark.parametrize("bad", [{"duration_s": 0.0}, {"gnss_hz": 0.0}, {"gnss_hz": 100.0}, {"imu_hz": -1.0}])
def test_a_drive_that_cannot_be_is_refused_in_a_sentence(bad: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"drive|gnss_hz"):
        drive(**bad)
