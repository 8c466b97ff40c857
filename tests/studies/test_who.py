"""Who is accused when a height drifts: the ramps, the gate, and what is counted."""

import numpy as np

import flown
from sensorfault.core.verdicts import FAULT
from sensorfault.runtime.replay import replay_log
from sensorfault_studies.multistep.who import LASTS_S, Ramp, gate, judged


def test_ramps_are_on_what_they_say() -> None:
    log = flown.flight(240.0)
    moved = {
        what: Ramp(what, 0.5, 100.0).on(log).value - log.value for what in ("height", "height-and-vd", "barometer")
    }
    during = (log.time >= 100.0) & (log.time < 100.0 + LASTS_S)
    for what, columns in (("height", [0]), ("height-and-vd", [0, 1]), ("barometer", [2])):
        changed = moved[what] != 0
        assert np.flatnonzero(changed.any(axis=0)).tolist() == columns
        assert not changed[~during].any()
        rise = moved[what][during, columns[0]]
        np.testing.assert_allclose(rise, 0.5 * (log.time[during] - 100.0), atol=1e-9)
    np.testing.assert_allclose(moved["height-and-vd"][during, 1], -0.5, atol=1e-9)  # down


def test_what_is_counted() -> None:
    log = flown.flight(240.0)
    monitor = gate(log.between(end_s=80.0))
    ramp = Ramp("height", 8.0, 100.0)
    found = replay_log(monitor, ramp.on(log))
    result = judged(found, log, ramp)
    assert result["detection_rate"] == result["named"] == 1.0
    assert result["delay_s"] < 5.0
    silent = found._replace(channel=np.zeros_like(found.channel), sample=np.zeros_like(found.sample))
    assert judged(silent, log, ramp) == {
        "detection_rate": 0.0, "delay_s": LASTS_S, "named": 0.0, "wrong_exclusions": 0.0,
    }  # fmt: skip
    late = (log.time >= 110.0) & (log.time < 111.0)
    silent.channel[late, 2] = silent.sample[late] = FAULT
    result = judged(silent, log, ramp)
    assert (result["detection_rate"], result["named"], result["wrong_exclusions"]) == (1.0, 0.0, 1.0)
    assert abs(result["delay_s"] - 10.0) < 1e-6
