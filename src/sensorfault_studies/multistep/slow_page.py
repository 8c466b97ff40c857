"""The findings on slow drifts: numbers, figures and remarks."""

from collections.abc import Sequence

from sensorfault.methods.height import drift_setting, ramp_glr, slope
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.multistep.slow import DRIFT, PLAIN, SHORT, WHERE, Slow, slow
from sensorfault_studies.multistep.slow_figures import figures
from sensorfault_studies.multistep.slow_judge import EVERY_S, LEAST_S, MATCHED, RATES, Result


def findings(effort: Effort) -> Findings:
    """All of D-slow.

    Raises:
        LogError: the real data do not exist.
    """
    result = slow(effort)
    rows = tuple(row for one in result for row in one.rows())
    return Findings(rows, tuple(figure for one in result for figure in figures(one)), remarks(result))


def remarks(result: Sequence[Slow]) -> tuple[str, ...]:
    """Remarks on the numbers of D-slow."""
    return (_reading(), *(_found(one) for one in result), *(_alike(one) for one in result), *_swept(result))


def _reading() -> str:
    setting = drift_setting.DEFAULT
    return (
        f"D-slow: receiver minus barometer at {1 / setting.beat_s:g} Hz, both averaged over a beat and aligned in time "
        f"with the barometer's own speed. Limits are {setting.margin:g} times the largest healthy score of the first "
        f"half of the flight. Ramps begin every {EVERY_S:g} s in the second half, until {LEAST_S:g} s before its end. "
        "A ramp that is not detected counts with the time to the end of the flight; so does chance_delay_s, the first "
        f"alarm without a ramp. {MATCHED}: the lowest limit without a false alarm in that same half, for a comparison "
        f"at a common false alarm rate; it cannot be set before the flight. {SHORT}: windows of 60 s. {PLAIN}: no lag "
        "between the two heights. No test uses the receiver's vertical speed, so height-and-vd repeats height."
    )


def _found(result: Slow) -> str:
    detected = []
    for method in (slope.NAME, ramp_glr.NAME):
        one = result.result[method, ""]
        detected.append(f"{method} detects 0.1, 0.3 and 1 m/s after {_times(one)} with {one.false} false events")
    return (
        f"D-slow, {result.data}: {'; '.join(detected)}. The barometer is assumed healthy: the difference of two "
        "heights does not show which of them drifts."
    )


def _alike(result: Slow) -> str:
    """The ranking of the tests by delay, without false alarms."""
    delay = {
        method: result.injected.mean(f"{MATCHED} {WHERE[0]}", method, "delay_s", DRIFT, RATES[0])
        for method, variant in result.result
        if not variant
    }
    ranked = sorted(delay, key=lambda method: delay[method])
    delays = ", ".join(f"{method} {delay[method]:.0f}" for method in ranked)
    ratios = ", ".join(f"{method} {result.result[method, ''].ratio:.2f}" for method in ranked)
    return (
        f"D-slow, {result.data}, {MATCHED}: mean delay at {RATES[0]} m/s [s]: {delays}. With limits that are known "
        "before the flight the tests differ in how much the take-off in the first half raises their scores above those "
        f"of the second half; largest healthy score of the second half divided by that of the first: {ratios}."
    )


def _swept(result: Sequence[Slow]) -> tuple[str, ...]:
    if not result[0].windows:
        return ()
    clean = [{w for w, one in each.windows[slope.NAME].items() if one.false == 0} for each in result]
    windows = ", ".join(f"{w:g}" for w in sorted(set.intersection(*clean)))
    return (
        f"D-slow: the window of {drift_setting.DEFAULT.window_s:g} s was chosen on these same two flights, because "
        f"there are no others. The slope has no false event on either flight with windows of {windows} s. A training "
        "flight of five minutes is too short to verify longer windows.",
    )


def _times(one: Result) -> str:
    return " / ".join(f"{d:.0f}" for d in one.delay.mean(axis=1)) + " s"
