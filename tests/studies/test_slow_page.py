"""What scores say under a limit, and that the page says what the numbers say; nothing is replayed here."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.stages.residual.difference import Difference
from sensorfault_studies.multistep.beats import Beats
from sensorfault_studies.multistep.slow import SHORT, Slow, _add
from sensorfault_studies.multistep.slow_figures import figures
from sensorfault_studies.multistep.slow_judge import HALF, MATCHED, RATES, Judged
from sensorfault_studies.multistep.slow_page import remarks
from sensorfault_studies.numbers import Numbers

TIME = np.arange(100.0)
ONSETS = np.array([60.0, 70.0])


def beats() -> Beats:
    channels = (Channel("altitude", "gnss", "m"), Channel("altitude", "barometer", "m"))
    value = np.zeros((100, 2))
    log = Log(TIME, value, value == 0, channels, (Sensor("gnss", 1.0), Sensor("barometer", 1.0)))
    nothing = jnp.zeros(())
    return Beats(log, TIME - 0.5, 50.0, Difference(nothing, nothing, nothing, nothing, nothing, 0, 1, 2))


def judged(healthy: np.ndarray) -> Judged:
    """A score that is what flies, or the ramp's height where that is more."""
    ramps = [rate * np.maximum(TIME - onset, 0.0) for rate in RATES for onset in ONSETS]
    return Judged(beats(), np.stack([healthy, *(np.maximum(healthy, ramp) for ramp in ramps)]), ONSETS, margin=1.1)


def test_delays_count_to_the_end_where_nothing_is_found() -> None:
    result = judged(np.where(TIME < 50, 2.0, 1.0)).judge(HALF)
    assert result.limit == pytest.approx(2.2)
    # 0.1 m/s passes 2.2 m after 22 s and more, 0.3 after 7.3, 1 after 2.2
    np.testing.assert_allclose(result.delay, [[23, 23], [8, 8], [3, 3]])
    assert not result.missed.any()
    assert result.ratio == 0.5
    assert (result.false, result.far) == (0, 0.0)
    assert result.chance_s == pytest.approx(np.mean(99 - ONSETS))
    dull = replace(judged(np.where(TIME < 50, 5.0, 1.0)), margin=1.0).judge(HALF)
    np.testing.assert_allclose(dull.delay[0], 99 - ONSETS)
    assert dull.missed[0].all()


def test_false_events_are_runs_of_alarms() -> None:
    healthy = np.where((TIME > 55) & (TIME < 58) | (TIME == 80), 4.0, 1.0)
    result = judged(healthy).judge(HALF)
    assert result.false == 2
    assert result.far == pytest.approx(3 / 50)
    assert result.chance_s == pytest.approx(np.mean(80 - ONSETS))
    matched = judged(healthy).judge(MATCHED)
    assert (matched.limit, matched.false) == (4.0, 0)


def test_the_page_says_what_the_numbers_say() -> None:
    result = Slow("proto", Numbers("D-slow", "proto", "real"), Numbers("D-slow", "proto", "injected"))
    seen = judged(np.where(TIME < 50, 2.0, 1.0))
    for method in ("slope", "ramp-glr"):
        _add(result, method, "", seen)
        _add(result, method, SHORT, seen)
        result.windows[method] = {60.0: seen.judge(HALF), 130.0: seen.judge(HALF)}
    rows = list(result.rows())
    delays = [row for row in rows if row.metric == "delay_s" and row.condition == "first-half height-and-vd"]
    assert {(row.method, row.magnitude, row.value) for row in delays} >= {("slope", 0.1, 23.0), ("ramp-glr", 1.0, 3.0)}
    assert {row.source for row in rows} == {"real", "injected"}
    said = " ".join(remarks([result]))
    assert "slope detects 0.1, 0.3 and 1 m/s after 23 / 8 / 3 s with 0 false events" in said
    assert "windows of 60, 130 s" in said
    drawn = figures(result)
    assert [figure.name for figure in drawn] == [f"d_slow_{what}_proto" for what in ("delay", "score", "window")]
    assert drawn[0].plot["data"][0]["y"] == [23.0, 8.0, 3.0]
