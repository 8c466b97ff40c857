"""What the study of slow drifts says: its numbers, figures and sentences."""

from collections.abc import Sequence

from sensorfault.methods.height import drift_setting, ramp_glr, slope
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.multistep.slow import DRIFT, PLAIN, SHORT, WHERE, Slow, slow
from sensorfault_studies.multistep.slow_figures import figures
from sensorfault_studies.multistep.slow_judge import EVERY_S, LEAST_S, MATCHED, RATES, Result


def findings(effort: Effort) -> Findings:
    """All of D-slow.

    Raises:
        LogError: the real data are not there.
    """
    result = slow(effort)
    rows = tuple(row for one in result for row in one.rows())
    return Findings(rows, tuple(figure for one in result for figure in figures(one)), remarks(result))


def remarks(result: Sequence[Slow]) -> tuple[str, ...]:
    """What the numbers do not say by themselves."""
    return (_reading(), *(_found(one) for one in result), *(_alike(one) for one in result), *_swept(result))


def _reading() -> str:
    setting = drift_setting.DEFAULT
    return (
        f"D-slow: at {1 / setting.beat_s:g} Hz, receiver minus barometer, both averaged over a beat and brought to one "
        f"moment by the barometer's own speed. Limits are {setting.margin:g} times the largest healthy score of the "
        f"first half of the flight; ramps begin every {EVERY_S:g} s of the second half until {LEAST_S:g} s before its "
        "end; a ramp that is not found counts with the time to the end of the flight, and so does chance_delay_s, the "
        f"first alarm without a ramp. {MATCHED}: the lowest limit that has no false alarm in that very half, for a "
        "comparison at one rate of false alarms, which nobody can set before the flight. "
        f"{SHORT}: windows of 60 s; {PLAIN}: both heights taken to show the same moment. No test "
        "listens to the receiver's vertical speed, so height-and-vd repeats height."
    )


def _found(result: Slow) -> str:
    said = []
    for method in (slope.NAME, ramp_glr.NAME):
        one = result.result[method, ""]
        said.append(f"{method} finds 0.1, 0.3 and 1 m/s after {_times(one)} with {one.false} false events")
    return (
        f"D-slow, {result.data}: {'; '.join(said)}. The barometer is assumed healthy: a difference of two cannot tell "
        "which of them drifts."
    )


def _alike(result: Slow) -> str:
    """Which test is the quickest where none is wrong."""
    delay = {
        method: result.injected.mean(f"{MATCHED} {WHERE[0]}", method, "delay_s", DRIFT, RATES[0])
        for method, variant in result.result
        if not variant
    }
    ranked = sorted(delay, key=lambda method: delay[method])
    said = ", ".join(f"{method} {delay[method]:.0f}" for method in ranked)
    ratios = ", ".join(f"{method} {result.result[method, ''].ratio:.2f}" for method in ranked)
    return (
        f"D-slow, {result.data}, {MATCHED}: mean delay at {RATES[0]} m/s [s]: {said}. What parts the tests under "
        "limits that can be known is how much a take-off in the first half moves them more than the flight in the "
        f"second does; largest healthy score of the second half over that of the first: {ratios}."
    )


def _swept(result: Sequence[Slow]) -> tuple[str, ...]:
    if not result[0].windows:
        return ()
    clean = [{w for w, one in each.windows[slope.NAME].items() if one.false == 0} for each in result]
    windows = ", ".join(f"{w:g}" for w in sorted(set.intersection(*clean)))
    return (
        f"D-slow: the window of {drift_setting.DEFAULT.window_s:g} s was chosen on these two flights, which are all "
        f"there are; the slope has no false event on either with windows of {windows} s, and longer windows promise "
        "delays that a training flight of five minutes cannot vouch for.",
    )


def _times(one: Result) -> str:
    return " / ".join(f"{d:.0f}" for d in one.delay.mean(axis=1)) + " s"
