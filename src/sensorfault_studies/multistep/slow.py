"""Slow drift: ramps in the second half of a flight, limits from the first half, and an independent reference."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from sensorfault.methods.catalog import METHODS
from sensorfault.methods.height import drift_setting
from sensorfault_studies.findings import Effort, Row
from sensorfault_studies.multistep.beats import Beats, compared
from sensorfault_studies.multistep.flights import FLIGHTS, flight
from sensorfault_studies.multistep.slow_judge import HALF, MATCHED, RATES, Judged, Result, judge
from sensorfault_studies.multistep.slow_rivals import SWEPT, TESTS
from sensorfault_studies.numbers import Numbers

EXPERIMENT, DRIFT = "D-slow", "drift"
WHERE = ("height", "height-and-vd")  # what drifts
WINDOWS = (60.0, 90.0, 110.0, 130.0, 150.0, 180.0)  # of the sweep [s]
SLOTS = 210  # enough for the longest window, so one compilation serves all
SHORT, PLAIN = "W60", "no-lag"  # a window of 60 s; no lag between the two heights


@dataclass
class Slow:
    """The results of one flight. `windows`: tests with windows of other lengths, by method."""

    data: str
    real: Numbers
    injected: Numbers
    result: dict[tuple[str, str], Result] = field(
        default_factory=dict
    )  # by method and variant; limits of the first half
    windows: dict[str, dict[float, Result]] = field(default_factory=dict)

    def rows(self) -> Iterator[Row]:
        """All numbers."""
        yield from self.real.rows()
        yield from self.injected.rows()


def slow(effort: Effort) -> list[Slow]:
    """Both flights; with `quick` only one, and only the recipes.

    Raises:
        LogError: the real data do not exist.
    """
    names = FLIGHTS[:1] if effort.quick else FLIGHTS
    return [_flight(name, (i / len(names), 1 / len(names)), effort) for i, name in enumerate(names)]


def _flight(name: str, share: tuple[float, float], effort: Effort) -> Slow:
    whole = compared(flight(name))
    found = Slow(name, Numbers(EXPERIMENT, name, "real"), Numbers(EXPERIMENT, name, "injected"))
    beats, plain = (Beats.of(name, whole, replace(drift_setting.DEFAULT, lagging=lagging)) for lagging in (True, False))
    tests = {method: test for method, test in TESTS.items() if method in METHODS or not effort.quick}
    for i, (method, test) in enumerate(tests.items()):
        effort.progress(f"{name}: slow ramps, {method}", share[0] + share[1] * i / len(tests))
        swept = () if effort.quick or method not in SWEPT else WINDOWS
        own = replace(test.setting, slots=SLOTS)
        settings = [own, *(replace(own, window_s=w) for w in swept)]
        seen = judge(beats, test, settings)
        _add(found, method, "", seen[0])
        if swept:
            found.windows[method] = {w: one.judge(HALF) for w, one in zip(swept, seen[1:], strict=True)}
            _add(found, method, SHORT, seen[1 + WINDOWS.index(60.0)])
            _add(found, method, PLAIN, judge(plain, test, settings)[0])  # all of them: compiled already
    return found


def _add(found: Slow, method: str, variant: str, judged: Judged) -> None:
    """No test uses the receiver's vertical speed, so it does not matter whether that drifts too."""
    found.result[method, variant] = result = judged.judge(HALF)
    own = f"{variant} {HALF}".strip()
    found.real.add(own, method, {"far": result.far, "false_events": result.false, "healthy_ratio": result.ratio})
    conditions = {f"{own} {where}": result for where in WHERE}
    conditions[f"{variant} {MATCHED} {WHERE[0]}".strip()] = judged.judge(MATCHED)
    for words, one in conditions.items():
        for rate, delay, missed in zip(RATES, one.delay, one.missed, strict=True):
            numbers = {"delay_s": delay.mean(), "missed": missed.mean(), "chance_delay_s": one.chance_s}
            found.injected.add(words, method, numbers, DRIFT, rate)
