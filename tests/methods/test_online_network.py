"""Paper B's recipe: what it watches and by what limits, alone and in groups, taught and from scratch."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from laws.cases.online_network import two_joints
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.arm.online_network import Setting, build
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model
from sensorfault.training.gradient import Plan
from sensorfault.training.online import Learning, noise, steps
from sensorfault.training.session import SILENT

RATES, ANGLES = ("tachometer1.rate", "tachometer2.rate"), ("encoder1.angle", "encoder2.angle")
LEARNING = Learning(plan=Plan(epochs=20, rate=1e-2))
HEALTHY_S = 40.0


@cache
def log() -> Log:
    return two_joints(2400)


@cache
def fitted(groups: tuple[tuple[str, ...], ...] = (), scratch: bool = False, slope: bool = False) -> Model:
    learning = replace(LEARNING, scratch=scratch, rate=0.3, iterations=1) if scratch else LEARNING
    setting = Setting(learning, groups, slope, {"encoder2.angle": 0.5})
    return build(log().between(end_s=HEALTHY_S), 0, SILENT, setting)


def shifted(path: str, start_s: float, by: float) -> Log:
    value = log().value.copy()
    value[log().time >= start_s, log().index(path)] += by
    return replace(log(), value=value)


def test_limits_are_given_or_those_of_the_tail_or_as_printed() -> None:
    value, columns = log().between(end_s=HEALTHY_S), range(4)
    sigma = noise(value.value[:, columns])
    np.testing.assert_allclose(sigma, 3e-3, rtol=0.1)  # what two_joints puts in
    limits = {slope: list(fitted(slope=slope).summary["limits"].values()) for slope in (False, True)}
    np.testing.assert_allclose(limits[True][:3], (steps(value, columns) + 3 * sigma)[:3])
    assert limits[False][3] == limits[True][3] == pytest.approx(0.5)
    assert (np.array(limits[False][:3]) > 4 * np.array(fitted().sigma[:3])).all()
    assert np.isinf(limits[False][4:]).all()
    assert fitted().summary["inputs"] == ["drive1.torque", "drive2.torque"]
    assert fitted().watched == (True, True, True, True, False, False)


def test_in_groups_what_one_network_foretells_is_nothing_to_the_other() -> None:
    model = fitted(groups=(ANGLES, RATES))
    alone, moved = (detect(model, one) for one in (log(), shifted("tachometer1.rate", 44.0, 0.02)))
    angles = [log().index(path) for path in ANGLES]
    np.testing.assert_array_equal(alone.repaired[:, angles], moved.repaired[:, angles])
    assert (alone.channel[1:, :4] == OK).mean() > 0.99
    lied = detect(model, shifted("encoder1.angle", 44.0, 0.3))
    assert next((event.sensor, event.start_s) for event in lied.events) == ("encoder1", pytest.approx(44.0))


def test_against_what_it_has_lately_been_a_shaking_arm_is_no_fault() -> None:
    """Five times the noise for a while: over fixed limits all the time, over those that follow only to begin with."""
    shaken = log().value.copy()
    rows = (log().time >= 44.0) & (log().time < 54.0)
    shaken[np.ix_(rows, range(4))] += 0.015 * np.random.default_rng(0).standard_normal((rows.sum(), 4))
    follows = build(log().between(end_s=HEALTHY_S), 0, SILENT, Setting(LEARNING, rms_ticks=20))
    assert follows.tests[0] == ("absolute, relative", "tachometer1.rate")
    later = log().time[rows] >= 47.0
    alarms = [
        (detect(model, replace(log(), value=shaken)).channel[rows][later] == FAULT).any(axis=1).mean()
        for model in (follows, fitted())
    ]
    assert alarms[0] < 0.1 < 0.3 < alarms[1]
    lied = detect(follows, shifted("encoder1.angle", 44.0, 0.3))
    assert next((event.sensor, event.start_s) for event in lied.events) == ("encoder1", pytest.approx(44.0))
    with pytest.raises(ValueError, match="in units of"):
        Setting(slope=True, rms_ticks=20)


def test_from_scratch_it_is_unknown_until_it_has_learned() -> None:
    part = log().between(HEALTHY_S)
    result = detect(fitted(scratch=True), part)
    known = (result.channel[:, :4] != UNKNOWN).all(axis=1)
    first = int(np.argmax(known))
    assert LEARNING.warm < first < 100
    assert not known[:first].any()
    assert (result.channel[first:, :4] == OK).mean() > 0.5


def test_a_group_of_what_cannot_be_foretold() -> None:
    with pytest.raises(LogError, match=r"drive1\.torque is marked watch = false; leave it out"):
        build(log(), 0, SILENT, Setting(groups=(("drive1.torque",),)))
