"""The motion deficit as a recipe: jams, offsets, the date line, the poles, long faults, and logs it cannot run on."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.position.motion_deficit import motion_deficit
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.result import Detection
from sensorfault.simulation.road import drive
from sensorfault.vehicles.car import roles

pytestmark = pytest.mark.usefixtures("hasty")

PATHS = [*(f"{s}.{axis}" for s in ("gyro", "accelerometer") for axis in "xyz")]
PATHS += [f"gnss.{name}" for name in ("latitude", "longitude", "speed", "course")]
LATITUDE, LONGITUDE, SPEED, COURSE = 6, 7, 8, 9
METRE = np.rad2deg(1 / 6.37e6)  # of latitude [deg]
FIRST, LAST = 180.0, 280.0  # of the part nobody was fitted on [s]; the car stands at 215-219 s and from 285 s
UNDER_WAY = 262.0  # at 13 m/s, and for ten seconds more


@cache
def log() -> Log:
    return drive(300.0, seed=3).log.select(PATHS)


@cache
def model(repeats: bool = True) -> Model:
    return motion_deficit("motion-deficit", log().between(end_s=FIRST), repeats)


def rest() -> Log:
    return log().between(FIRST, LAST)


def position_faults(found: Detection) -> np.ndarray:
    """Times at which the position is called faulty [s]."""
    return found.log.time[(found.channel[:, [LATITUDE, LONGITUDE]] == FAULT).all(axis=1)]


def frozen(start_s: float, length_s: float, *channels: str) -> list[Fault]:
    return [Fault("frozen", "gnss", name, start_s, length_s) for name in channels or ("latitude", "longitude")]


def test_a_healthy_drive_is_ok_standing_or_not() -> None:
    found = detect(model(), rest())
    assert not found.events
    warm = found.log.time > FIRST + 3.0
    assert (found.channel[warm][:, [LATITUDE, LONGITUDE]] == OK).mean() > 0.98  # now and then no fix comes in time
    assert (found.channel[:, :6] == UNKNOWN).all()


@pytest.mark.parametrize("repeats", [True, False])
def test_a_jam_is_found_at_once_and_over_with_its_end(repeats: bool) -> None:
    struck = inject(rest(), frozen(UNDER_WAY, 5.0)).log
    at = position_faults(detect(model(repeats), struck))
    assert UNDER_WAY <= at[0] <= UNDER_WAY + (0.3 if repeats else 0.5)
    assert UNDER_WAY + 4.8 <= at[-1] <= UNDER_WAY + 5.2
    assert len(at) > 4.4 / log().period_s
    events = detect(model(repeats), struck).events
    assert {event.kind for event in events} == {"frozen"}
    assert all("latitude" in result or "longitude" in result for result in (event.channel or "" for event in events))


def test_a_jam_that_dithers_is_found_by_the_missing_way() -> None:
    struck = inject(rest(), frozen(UNDER_WAY, 5.0)).log
    value = struck.value.copy()
    inside = (struck.time >= UNDER_WAY) & (struck.time < UNDER_WAY + 5.0) & struck.fresh[:, LATITUDE]
    value[inside, LATITUDE] += np.deg2rad(0.05 * METRE) * np.random.default_rng(0).standard_normal(inside.sum())
    found = detect(model(), replace(struck, value=value))
    fresh = inside & (struck.time > UNDER_WAY + 0.5)
    assert (found.channel[fresh, LATITUDE] == FAULT).mean() > 0.95


def test_the_stand_in_goes_on_while_the_position_is_frozen() -> None:
    healthy = rest()
    struck = inject(healthy, frozen(UNDER_WAY, 4.0)).log
    repaired = detect(model(), struck).repaired
    inside = (struck.time >= UNDER_WAY + 1.0) & (struck.time < UNDER_WAY + 3.9) & struck.fresh[:, LATITUDE]
    for channel, metre in ((LATITUDE, 1.0), (LONGITUDE, 1 / np.cos(0.891))):
        off = (repaired - healthy.value)[inside, channel] / np.deg2rad(METRE * metre)
        jammed = (struck.value - healthy.value)[inside, channel] / np.deg2rad(METRE * metre)
        assert np.abs(off).max() < 4.0
        assert np.abs(off).max() < 0.2 * np.abs(jammed).max() + 2.0
    assert np.isfinite(repaired[inside]).all()


def test_an_offset_is_found_and_only_trusted_fixes_are_references() -> None:
    struck = inject(rest(), [Fault("offset", "gnss", "latitude", UNDER_WAY, 6.0, 30 * METRE)]).log
    at = position_faults(detect(model(), struck))
    assert at[0] <= UNDER_WAY + 0.2
    # a reference taken from the lie would call it healthy after a second
    assert at[(at < UNDER_WAY + 6.0)][-1] > UNDER_WAY + 3.0


def test_a_long_offset_is_no_lock_out() -> None:
    struck = inject(log().between(FIRST), [Fault("offset", "gnss", "latitude", 200.0, 200.0, 2000 * METRE)]).log
    found = detect(model(), struck)
    at = position_faults(found)
    assert at[0] <= 200.3
    late = found.log.time > 200.0 + 35.0  # thirty seconds without a trusted fix, then it begins anew
    assert (found.channel[late][:, LATITUDE] == OK).mean() > 0.9
    assert at[-1] < 235.0


def moved(there: Log, longitude: float) -> Log:
    """The same drive elsewhere on its parallel, where longitudes may pass from 180 to -180 degrees."""
    value = there.value.copy()
    value[:, LONGITUDE] = np.mod(value[:, LONGITUDE] + longitude + np.pi, 2 * np.pi) - np.pi
    return replace(there, value=value)


def test_the_date_line_is_a_place_like_any_other() -> None:
    there = rest()
    middle = float(there.value[np.searchsorted(there.time, UNDER_WAY + 3.0), LONGITUDE])
    other = moved(there, np.pi - middle)
    assert np.ptp(other.value[:, LONGITUDE]) > 6
    here, across = detect(model(), there), detect(model(), other)
    np.testing.assert_array_equal(across.channel, here.channel)
    for one, two in zip(here.traces, across.traces, strict=True):
        np.testing.assert_allclose(two.score, one.score, atol=1e-4)


def test_at_a_pole_nothing_is_said_and_nothing_breaks() -> None:
    there = rest()
    value = there.value.copy()
    value[:, LATITUDE] += np.deg2rad(89.95) - value[0, LATITUDE]
    found = detect(model(), replace(there, value=value))
    assert (found.channel[:, [LATITUDE, LONGITUDE]] == UNKNOWN).all()
    # speed and course know no poles
    assert (found.channel[:, SPEED] == OK).any()


def test_wild_positions_are_no_positions() -> None:
    there = rest()
    value = there.value.copy()
    value[3000:3100, LATITUDE] = 1e300
    found = detect(model(), replace(there, value=value))
    assert (found.channel[4000:, LATITUDE] == OK).any()


@pytest.mark.parametrize(("name", "column", "lie"), [("speed", SPEED, 15.0), ("course", COURSE, 1.5)])
def test_a_lie_of_the_velocity_is_seen_by_the_inertial_unit(name: str, column: int, lie: float) -> None:
    there = rest()
    value = there.value.copy()
    value[(there.time >= UNDER_WAY) & (there.time < UNDER_WAY + 2.0), column] += lie
    found = detect(model(), replace(there, value=value))
    at = found.log.time[found.channel[:, column] == FAULT]
    assert UNDER_WAY <= at[0] < UNDER_WAY + 0.2
    assert at[-1] < UNDER_WAY + 8.0


def test_north_and_east_will_do_and_no_inertial_unit_is_needed() -> None:
    there = log().select(PATHS[6:])
    value = there.value.copy()
    speed, course = there.value[:, 2], there.value[:, 3]
    value[:, 2], value[:, 3] = speed * np.cos(course), speed * np.sin(course)
    north, east = (replace(there.channels[2], name=name, unit="m/s") for name in ("north", "east"))
    bare = replace(there, value=value, channels=(*there.channels[:2], north, east))
    assert not roles(bare).polar
    made = motion_deficit("motion-deficit", bare.between(end_s=FIRST))
    assert "no gyro" in str(made.summary["cannot"])
    assert made.watched == (True, True, False, False)
    found = detect(made, inject(bare.between(FIRST, LAST), frozen(UNDER_WAY, 3.0)).log)
    at = found.log.time[(found.channel[:, :2] == FAULT).all(axis=1)]
    assert UNDER_WAY <= at[0] < UNDER_WAY + 0.5
    assert at[-1] < UNDER_WAY + 3.3


def test_what_it_cannot_run_on_is_said_in_one_sentence() -> None:
    there = log().between(end_s=60.0)
    for paths, words in (
        (["gnss.speed", "gnss.course"], "no position"),
        (["gnss.latitude", "gnss.longitude"], "no velocity over ground"),
    ):
        with pytest.raises(LogError, match=words):
            motion_deficit("motion-deficit", there.select([*PATHS[:6], *paths]))
    parked = there.value.copy()
    parked[:, SPEED] = 0.0
    with pytest.raises(LogError, match="give a drive that moves"):
        motion_deficit("motion-deficit", replace(there, value=parked))
    polar = there.value.copy()
    polar[:, LATITUDE] = np.pi / 2
    with pytest.raises(LogError, match="pole"):
        motion_deficit("motion-deficit", replace(there, value=polar))


def test_a_receiver_of_one_hertz() -> None:
    """Its horizons are one and four of its periods; no fix comes within a quarter of a second."""
    slow = drive(300.0, seed=3, imu_hz=10.0, gnss_hz=1.0).log.select(PATHS)
    model = motion_deficit("motion-deficit", slow.between(end_s=FIRST), True)
    assert [test for test, _ in model.tests[:2]] == ["deficit over 0.9 s", "deficit over 3.6 s"]
    part = slow.between(FIRST, LAST)
    assert not (detect(model, part).channel[:, LATITUDE] == FAULT).any()
    found = position_faults(
        detect(model, inject(part, [Fault("offset", "gnss", "latitude", 240.0, 10.0, 40 * METRE)]).log)
    )
    assert 240.0 <= found.min() < 242.0
