"""Slow drift done right: ramps in the second half of a flight, limits from the first, an independent reference."""

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
SLOTS = 210  # for the longest of them: one compilation serves all
SHORT, PLAIN = "W60", "no-lag"  # the prototype's window; both heights taken to show the same moment


@dataclass
class Slow:
    """Of one flight: numbers, and what the figures show. `windows`: tests with windows of other lengths, by method."""

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
    """Both flights; for a look one, and the recipes alone.

    Raises:
        LogError: the real data are not there.
    """
    names = FLIGHTS[:1] if effort.quick else FLIGHTS
    return [_flight(name, (i / len(names), 1 / len(names)), effort) for i, name in enumerate(names)]


def _flight(name: str, share: tuple[float, float], effort: Effort) -> Slow:
    whole = compared(flight(name))
    found = Slow(name, Numbers(EXPERIMENT, name, "real"), Numbers(EXPERIMENT, name, "injected"))
    beats, plain = (Beats.of(name, whole, replace(drift_setting.DEFAULT, lagging=lagging)) for lagging in (True, False))
    tests = {method: test for method, test in TESTS.items() if method in METHODS or not effort.quick}
    for i, (method, test) in enumerate(tests.items()):
        effort.tell(f"{name}: slow ramps, {method}", share[0] + share[1] * i / len(tests))
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
    """The barometer knows nothing of the receiver's vertical speed, so it is no matter whether that drifts too."""
    found.result[method, variant] = result = judged.judge(HALF)
    own = f"{variant} {HALF}".strip()
    found.real.add(own, method, {"far": result.far, "false_events": result.false, "healthy_ratio": result.ratio})
    conditions = {f"{own} {where}": result for where in WHERE}
    conditions[f"{variant} {MATCHED} {WHERE[0]}".strip()] = judged.judge(MATCHED)
    for words, one in conditions.items():
        for rate, delay, missed in zip(RATES, one.delay, one.missed, strict=True):
            numbers = {"delay_s": delay.mean(), "missed": missed.mean(), "chance_delay_s": one.chance_s}
            found.injected.add(words, method, numbers, DRIFT, rate)
