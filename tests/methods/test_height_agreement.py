"""Who lies about the height: named if a third witness knows, unknown which if none does, and never the healthy one."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

import flown
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs import guess
from sensorfault.logs.rates import hold_s
from sensorfault.logs.read import read
from sensorfault.logs.table import Channel, Log, LogError, Sensor
from sensorfault.methods.height.height_agreement import LEAST_S, build
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model, owners
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.whitened import Whitened
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.height_kalman import fit_height_kalman
from sensorfault.training.session import SILENT
from sensorfault.vehicles.fixed_wing import roles
from sensorfault_studies.multistep.flights import FLIGHTS, flight

pytestmark = pytest.mark.usefixtures("hasty")

GNSS, DOWN, BARO, INS = "gnss.altitude", "gnss.down", "barometer.altitude", "ins.up"
FITTED_S, ONSET_S, LASTS_S = 300.0, 380.0, 60.0


@cache
def log(*paths: str) -> Log:
    """A simulated flight of a quarter of an hour, as these channels tell it. The inertial vertical speed has a bias."""
    whole = flown.flight(900.0, seed=1)
    climb = np.gradient(whole.value[:, flown.BARO], whole.time)
    climb = np.convolve(np.pad(climb, 12, mode="edge"), np.full(25, 1 / 25), mode="valid") + 0.02
    more = replace(
        whole,
        value=np.column_stack([whole.value, climb]),
        fresh=np.column_stack([whole.fresh, np.ones(len(climb), bool)]),
        channels=(*whole.channels, Channel("up", "ins", "m/s")),
        sensors=(*whole.sensors, Sensor("ins", whole.period_s)),
    )
    return more.select(paths)


@cache
def fitted(*paths: str) -> Model:
    return build(log(*paths).between(end_s=FITTED_S), 0, SILENT)


def lied(*faults: Fault, paths: tuple[str, ...]):
    part = log(*paths).between(FITTED_S)
    return part, detect(fitted(*paths), inject(part, list(faults)).log)


def drift(sensor: str, rate: float, channel: str = "altitude") -> Fault:
    return Fault("drift", sensor, channel, ONSET_S, LASTS_S, rate)


def accused(result, paths: tuple[str, ...]) -> set[str]:
    return {path for c, path in enumerate(paths) if (result.channel[:, c] == FAULT).any()}


def test_a_healthy_flight_is_ok() -> None:
    paths = (GNSS, DOWN, BARO, INS)
    part, result = lied(paths=paths)
    assert not result.events
    late = part.time > FITTED_S + 70.0
    assert (result.channel[late] == OK).mean() > 0.99
    assert (result.channel[part.time < FITTED_S + 3.0] == UNKNOWN).all()


@pytest.mark.parametrize(("sensor", "path"), [("gnss", GNSS), ("barometer", BARO)])
def test_a_slow_drift_of_20_m_is_laid_on_who_drifts_if_inertial_data_say_so(sensor: str, path: str) -> None:
    paths = (GNSS, BARO, INS)
    part, result = lied(drift(sensor, 1 / 3), paths=paths)
    assert accused(result, paths) == {path}
    event = [event for event in result.events if event.sensor][-1]
    assert event.sensor == sensor
    assert ONSET_S < event.start_s < ONSET_S + 25.0
    # the other one stands in, while it lasts
    c, rows = paths.index(path), (part.time > event.start_s) & (part.time < ONSET_S + LASTS_S)
    assert np.abs(result.repaired[rows, c] - part.value[rows, c]).max() < 2.0
    # and it is all over soon after
    after = part.time > ONSET_S + LASTS_S + 20.0
    assert (result.channel[after] == OK).mean() > 0.95


def test_a_chi_square_gate_lets_the_gps_lead_it_and_blames_the_barometer() -> None:
    """The companion filter with limits that no healthy sample of its flight passes."""
    whole = log(GNSS, DOWN, BARO)
    part = whole.between(FITTED_S)
    channels = len(whole.channels)
    filter = fit_height_kalman(whole.between(end_s=FITTED_S), 0, roles(whole))
    gate = Branch(Whitened(((0,), (1,), (2,)), channels), Fixed(jnp.full(3, jnp.inf)))
    owner = owners(whole.channels, whole.sensors)
    monitor = Monitor(filter, (gate,), Exceed(), Drop(), jnp.asarray(hold_s(whole)), owner, most=1)
    healthy = np.nanmax(np.asarray(replay_log(monitor, whole).scores[0])[50:], axis=0)
    gated = replace(monitor, branches=(replace(gate, threshold=Fixed(jnp.asarray(1.02 * healthy))),))
    both = Fault("offset", "gnss", "down", ONSET_S, LASTS_S, -1 / 3)  # a receiver that drifts believes its own climb
    result = replay_log(gated, inject(part, [drift("gnss", 1 / 3), both]).log)
    first = [np.flatnonzero(result.channel[:, c] == FAULT) for c in range(channels)]
    assert first[2].size
    assert all(not other.size or other[0] > first[2][0] for other in first[:1])


def test_unknown_which_when_nobody_else_knows() -> None:
    """Two heights alone; and with a receiver whose speed follows its height."""
    both = Fault("offset", "gnss", "down", ONSET_S, LASTS_S, -1.0)
    for paths, faults in (((GNSS, BARO), ()), ((GNSS, DOWN, BARO), (both,))):
        for sensor in ("gnss", "barometer"):
            part, result = lied(drift(sensor, 1.0), *(faults if sensor == "gnss" else ()), paths=paths)
            during = (part.time > ONSET_S + 15.0) & (part.time < ONSET_S + LASTS_S - 1.0)
            assert not (result.channel[during] == FAULT).any()
            assert (result.sample[during] == FAULT).all()
            assert (result.channel[during][:, paths.index(BARO)] == UNKNOWN).all()
            assert {(event.sensor, event.kind) for event in result.events if event.start_s < ONSET_S + LASTS_S - 1} == {
                (None, "unknown")
            }


def test_a_receiver_is_one_even_where_the_log_has_its_height_and_speed_as_two() -> None:
    """As `init` guesses. Else the barometer alone would explain that both differ from it."""
    whole = log(GNSS, DOWN, BARO)
    height, down, baro = whole.channels
    apart = replace(
        whole,
        channels=(replace(height, sensor="gps_height"), replace(down, sensor="gps_velocity"), baro),
        sensors=tuple(Sensor(name, 0.2) for name in ("gps_height", "gps_velocity", "barometer")),
    )
    model = build(apart.between(end_s=FITTED_S), 0, SILENT)
    faults = [
        Fault("drift", "gps_height", "altitude", ONSET_S, LASTS_S, 1.0),
        Fault("offset", "gps_velocity", "down", ONSET_S, LASTS_S, -1.0),
    ]
    result = detect(model, inject(apart.between(FITTED_S), faults).log)
    assert "barometer" not in {event.sensor for event in result.events}
    during = (result.log.time > ONSET_S + 15.0) & (result.log.time < ONSET_S + LASTS_S - 1.0)
    assert (result.sample[during] == FAULT).all()


def test_two_of_one_sensor_that_disagree_accuse_it() -> None:
    """Without a barometer the receiver's own speed tells that something is wrong with the receiver."""
    _, result = lied(drift("gnss", 1.0), paths=(GNSS, DOWN))
    assert {event.sensor for event in result.events} == {"gnss"}


def test_a_jump_is_told_at_once() -> None:
    _, result = lied(Fault("offset", "gnss", "altitude", ONSET_S, 20.0, 15.0), paths=(GNSS, DOWN, BARO, INS))
    assert {event.sensor for event in result.events if event.sensor} == {"gnss"}
    assert result.events[0].start_s < ONSET_S + 2.0
    soon = np.abs(result.log.time - ONSET_S - 10.0) < 7.0
    np.testing.assert_array_equal((result.channel[soon] == FAULT).all(axis=0), [True, False, False, False])


def test_a_witness_set_anew_is_believed_again() -> None:
    """After five minutes, and another to fill the memory: the barometer's setting was changed for good."""
    paths = (GNSS, BARO, INS)
    part, result = lied(Fault("offset", "barometer", "altitude", ONSET_S, 1e3, 15.0), paths=paths)
    assert accused(result, paths) == {BARO}
    since = part.time - ONSET_S
    assert (result.channel[(since > 10.0) & (since < 60.0), 1] == FAULT).all()
    assert (result.sample[(since > 10.0) & (since < 280.0)] == FAULT).all()  # later the inertial speed's bias hides who
    assert (result.channel[since > 400.0] == OK).all()


def test_a_vertical_speed_is_named_and_believed_again() -> None:
    """What it added up to while it lied stays wrong."""
    paths = (GNSS, DOWN, BARO)
    part, result = lied(Fault("offset", "gnss", "down", ONSET_S, 20.0, 2.0), paths=paths)
    assert accused(result, paths) == {DOWN}
    assert (result.channel[np.abs(part.time - ONSET_S - 14.0) < 5.0][:, 1] == FAULT).all()
    assert (result.channel[part.time > ONSET_S + 20.0 + 75.0] == OK).all()


def test_what_cannot_be_compared_is_said() -> None:
    with pytest.raises(LogError, match="has 1 channels of its height"):
        build(log(GNSS).between(end_s=FITTED_S), 0, SILENT)
    with pytest.raises(LogError, match="30 s long, but height-agreement needs 120 s"):
        build(log(GNSS, BARO).between(end_s=30.0), 0, SILENT)


@pytest.mark.real
@pytest.mark.usefixtures("real_data")
def test_on_real_flights() -> None:
    """Limits from the first half; in the second nothing, and no ramp of the receiver's height is another's fault."""
    for name in FLIGHTS:
        whole = flight(name)
        half = float(whole.time[0]) + whole.duration_s / 2
        model, rest = build(whole.between(end_s=half), 0, SILENT), whole.between(half)
        height = whole.channels[whole.index(GNSS)]
        assert not (replay_log(model.monitor, rest).sample == FAULT).any()
        for rate in (0.3, 1.0):
            size = rate * (1e3 if height.unit == "mm" else 1.0)
            ramp = Fault("drift", "gnss", "altitude", float(rest.time[0]) + 140.0, 90.0, size)
            result = replay_log(model.monitor, inject(rest, [ramp]).log)
            wrong = [c.path for i, c in enumerate(whole.channels) if (result.channel[:, i] == FAULT).any()]
            assert (result.sample == FAULT).any()
            assert set(wrong) <= {GNSS, DOWN}


@pytest.mark.real
def test_copters_raise_nothing(real_data: Path) -> None:
    """Read as `init` understands them; their two heights wander by up to 4 m in a minute."""
    flights = [read(path, guess(path)) for path in sorted((real_data / "uav" / "copter_jd2014").glob("*.bin"))]
    long = [whole for whole in flights if whole.duration_s > 4 * LEAST_S]  # half of it is fitted on
    assert len(long) >= 2
    for whole in long:
        half = float(whole.time[0]) + whole.duration_s / 2
        model, rest = build(whole.between(end_s=half), 0, SILENT), whole.between(half)
        result = replay_log(model.monitor, rest)
        assert not (result.sample == FAULT).any()
        assert (result.sample == OK).mean() > 0.8
