"""The recipe on simulated drives: what it finds, whom it accuses, what it cannot run on."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sensorfault.calibration.gumbel import gumbel_limit
from sensorfault.calibration.whiteness import whiten
from sensorfault.faults.motion import Felt, MotionFault, move
from sensorfault.logs.table import Log, LogError
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.methods.position.bicycle_kalman import bicycle_kalman
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.simulation.road import drive

FELT = Felt((6, 7), (9, 10), True, (3, 4, 5), (0, 1, 2))


@cache
def log() -> Log:
    return drive(240.0, seed=3).log


@cache
def model() -> Model:
    return bicycle_kalman("bicycle-kalman", log().between(end_s=120.0))


def unseen() -> Log:
    return log().between(120.0)


def test_healthy_is_quiet() -> None:
    assert detect(model(), unseen()).events == ()


@pytest.mark.parametrize("fault", [MotionFault("side slip", 150.0, 3.0, 3.0), MotionFault("spin", 150.0, 2.0, 1.2)])
def test_a_motion_is_told_as_one(fault: MotionFault) -> None:
    events = detect(model(), move(unseen(), fault, FELT)).events
    assert events
    assert {event.subject for event in events} == {"motion"}
    assert {event.sensor for event in events} == {None}
    assert fault.start_s <= events[0].start_s <= fault.end_s + 5


def test_the_sizes_of_its_innovations() -> None:
    assert model().summary["turned_by"] == "yaw rate"


@pytest.mark.parametrize(
    ("without", "said"),
    [
        (("gnss.latitude",), "no latitude and longitude"),
        (("gnss.speed",), "no speed"),
        (("gyro.z",), "no gyro with x, y, z, nor a steering angle"),
    ],
)
def test_what_is_missing_is_said(without: tuple[str, ...], said: str) -> None:
    part = log().between(end_s=60.0)
    with pytest.raises(LogError, match=said):
        bicycle_kalman("bicycle-kalman", part.select(c.path for c in part.channels if c.path not in without))


def test_a_drive_that_never_moves() -> None:
    value = log().value.copy()
    value[:, 9] = 0.0
    with pytest.raises(LogError, match="give a drive that moves"):
        bicycle_kalman("bicycle-kalman", replace(log(), value=value))


def test_a_wheelbase_of_nothing() -> None:
    with pytest.raises(LogError, match="wheelbase_m is 0; it must be positive"):
        bicycle_kalman("bicycle-kalman", replace(log(), wheelbase_m=0.0))
    text = "[vehicle]\nname = 'car'\nwheelbase_m = 0.0\n[file.log]\n[sensor.a.channel]\nx = { column = 'x' }\n"
    with pytest.raises(LogError, match=r"wheelbase_m = 0 must be positive"):
        VehicleFile.parse(text)
    there = VehicleFile.parse(text.replace("0.0", "2.65\nsteering_ratio = 14.5"))
    assert (there.wheelbase_m, there.steering_ratio) == (2.65, 14.5)
    assert VehicleFile.parse(there.to_toml()) == there


def test_gumbel_limit() -> None:
    """Passed as often as asked for, and not moved by a few blocks with faults."""
    random = np.random.default_rng(0)
    time = np.arange(0.0, 36000.0, 0.5)
    score = random.gumbel(size=(len(time), 1))
    limit = gumbel_limit(score, time, 10.0, 5.0)
    assert 5 <= (score[:, 0] > limit[0]).sum() / 10 <= 20
    score[1000:5000] += 1000.0
    assert gumbel_limit(score, time, 10.0, 5.0) == pytest.approx(limit, rel=0.15)
    assert gumbel_limit(score[:20], time[:20], 10.0, 5.0) == np.inf


def test_whiten() -> None:
    random = np.random.default_rng(1)
    noise = random.standard_normal((20000, 2))
    for t in range(1, len(noise)):
        noise[t, 1] += 0.6 * noise[t - 1, 1]
    found = whiten(noise, np.arange(20000) / 10, 10.0)
    np.testing.assert_array_equal(found.every, [1, 3])
    np.testing.assert_allclose(found.sigma, [1.0, 1.25], rtol=0.05)
