"""What the numbers do not say by themselves."""

from math import isfinite

from sensorfault_studies.findings import Effort
from sensorfault_studies.niu1998.drifts import (
    AT_RATE,
    ELSEWHERE,
    FAST,
    FOUND,
    NAMES,
    QUICK,
    SETTINGS,
    SLOWER,
    Drifts,
    smallest,
)
from sensorfault_studies.niu1998.isolation import LASTING
from sensorfault_studies.niu1998.joints import EACH, NEW, QUICK_EACH, SHOWN, SINGLE, Joints
from sensorfault_studies.niu1998.rivals import AS_PRINTED, DEEP, FIXED, KALMAN, NETWORK, PLAIN, SCRATCH
from sensorfault_studies.niu1998.run import ONSET, RUNS, SENSORS, WITHIN
from sensorfault_studies.niu1998.schunk import PERIOD_S

PRINTED = "as-printed"
HARDER = "far1e-3"
EXTRAPOLATION = PLAIN[1]
FIVE = {"spike": 5.0, "offset": 5.0, "frozen": LASTING * PERIOD_S}


def remarks(run: Drifts, arm: Joints, effort: Effort) -> tuple[str, ...]:
    """In the order of the tables."""
    return (_start(run), _seeds(effort), _network(run), _plain(run), _errors(run), *_slow(run, effort), *_real(arm))


def _start(run: Drifts) -> str:
    starts = "; ".join(f"{name} {setting.start}" for name, setting in SETTINGS.items())
    y2, y4 = (run.numbers.mean(PRINTED, NETWORK, f"theta_{y}", "drift") for y in NAMES)
    return (
        f"B: x(0) is not printed and was chosen so that the paper's rule, largest slope times T and three standard "
        f"deviations of the noise, gives about its thresholds ({y2:.4f} rad/s and {y4:.4f} rad for 0.024 and 0.0182); "
        f"rates [rad/s], angles [rad]: {starts}. The second input is printed as another u1 of 125 N m; 'physical' has "
        f"25 and a5 = 24.06. Drift rates are not printed: {FAST:g} thresholds a sample on {SENSORS[0]} (y2) and "
        f"{SENSORS[1]} (y4) from sample {ONSET} on; magnitudes of simulated drifts are thresholds a sample."
    )


def _seeds(effort: Effort) -> str:
    seeds, each = (1, QUICK_EACH) if effort.quick else (effort.seeds, EACH)
    return (
        f"B: a seed is a network (its first weights), the healthy runs that it is fitted on and {RUNS} noisy runs that "
        f"it is judged on, {seeds * RUNS} runs in all; on the real arm {each} faults of each kind and size on each "
        f"sensor. {AT_RATE}: limits that 5 % of other healthy runs pass before sample {ONSET}; far: share of runs with "
        "an alarm before it; detection_rate: share with both drifts found at sample 51 or 52; untested: share of the "
        "samples before it in which the four sensors are unknown."
    )


def _network(run: Drifts) -> str:
    said = []
    for words in (PRINTED, f"{PRINTED} {SCRATCH}", f"{PRINTED} {AS_PRINTED}"):
        rate, far, blank = (run.numbers.mean(words, NETWORK, m, "drift") for m in ("detection_rate", "far", "untested"))
        said.append(f"{rate:.0%} found, {far:.1%} with an early alarm, {blank:.0%} of the samples before untested")
    moved = {f"{NETWORK}{v}": (NETWORK, v) for v in ("", f" {SCRATCH}")} | {m: (m, "") for m in (*PLAIN, KALMAN)}
    elsewhere = ", ".join(
        f"{name} {run.numbers.mean(f'{PRINTED}{variant} {AT_RATE} other-start', method, 'far'):.0%}"
        for name, (method, variant) in moved.items()
    )
    return (
        f"B: the recipe, trained before on healthy runs of the same motion and learning increments: {said[0]}. The "
        f"same beginning with random weights ('{SCRATCH}'): {said[1]}. Absolute values learned from scratch, each "
        f"sample to convergence, as printed ('{AS_PRINTED}'): {said[2]}; what is learned to convergence is learned "
        "with its noise, so the others move a prediction by a third of its error. What is trained "
        f"knows the motion, not the arm: at the limits of {AT_RATE}, started from {ELSEWHERE.start}, healthy runs with "
        f"an early alarm are {elsewhere}."
    )


def _plain(run: Drifts) -> str:
    found = {m: run.numbers.mean(f"{PRINTED} {AT_RATE}", m, "detection_rate", "drift") for m in (*PLAIN, KALMAN)}
    early = run.numbers.mean(PRINTED, PLAIN[0], "far", "drift")
    return (
        f"B: under the paper's thresholds persistence raises an early alarm in {early:.0%} of the runs, since the "
        "largest slope is already the whole of the threshold and the difference of two measurements has √2 times their "
        f"noise. At one rate of false alarms it finds both drifts as soon in {found[PLAIN[0]]:.0%}, linear "
        f"extrapolation in {found[PLAIN[1]]:.0%}, the Kalman filter that knows the arm in {found[KALMAN]:.0%}: what "
        "drifts by two thresholds a sample needs no network. The filter is as good as its arm: told the other a5 "
        "(24.6 for 24.06), its recipe refuses these runs as those of another arm."
    )


def _errors(run: Drifts) -> str:
    def error(words: str, method: str) -> str:
        return f"{run.numbers.mean(words, method, 'rms_y2'):.4f}"

    result = []
    for start in ("", " from-rest"):
        free = [
            error(f"{PRINTED}{start} {AS_PRINTED} noise-free", NETWORK),
            error(f"{PRINTED}{start} noise-free", PLAIN[0]),
            error(f"{PRINTED}{start} noise-free", NETWORK),
            error(f"{PRINTED}{start} noise-free", EXTRAPOLATION),
        ]
        result.append(
            f"absolute values learned from scratch {free[0]}, persistence {free[1]}, increments {free[2]}, linear "
            f"extrapolation {free[3]}"
        )
    noisy = [error(PRINTED, method) for method in (NETWORK, EXTRAPOLATION, KALMAN)]
    return (
        f"B: one-step error of the second joint's rate without noise [rad/s], with the printed input: {result[0]}; "
        f"from rest: {result[1]}. With the paper's noise a straight line pays with √6 times that noise ({noisy[1]}), "
        f"the network averages ({noisy[0]}), and what the filter leaves is nearly the sensor's own ({noisy[2]})."
    )


def _slow(run: Drifts, effort: Effort) -> tuple[str, ...]:
    rates = QUICK if effort.quick else SLOWER
    said = []
    for y in NAMES:
        least = {}
        for variant in ("", SCRATCH):
            words = " ".join(part for part in (PRINTED, variant, AT_RATE, y) if part)
            least[f"{NETWORK} {variant}".strip()] = smallest(run.numbers, words, NETWORK, rates)
        least |= {m: smallest(run.numbers, f"{PRINTED} {AT_RATE} {y}", m, rates) for m in (*PLAIN, KALMAN)}
        each = ", ".join(f"{name} {rate:g}" if isfinite(rate) else f"{name} none" for name, rate in least.items())
        said.append(f"{y}: {each}")
    return (
        f"B: smallest drift of those tried that is found within {WITHIN} samples in {FOUND:.0%} of the runs, at one "
        f"rate of false alarms [thresholds a sample]: {'; '.join(said)}. What is foretold from the last measurement "
        "shows a drift only as long as it is not learned: below a threshold a sample the next window already has it in "
        "it, as the paper says. A filter that knows the arm adds it up. So does the trained network for y2, whose "
        "motion it has learned by heart, and not for y4, of which it is told where it is by nothing but y4.",
    )


def _real(arm: Joints) -> tuple[str, ...]:
    def rate(words: str, method: str, kind: str, group: str = "all") -> float:
        return arm.injected.mean(f"{words} {group}", method, "detection_rate", kind, FIVE[kind])

    def each(words: str) -> str:
        pooled = arm.injected.mean(f"{words} all", NETWORK, "detection_rate", " or ".join(SINGLE))
        return ", ".join(f"{kind} {rate(words, NETWORK, kind):.1%}" for kind in SINGLE) + f", together {pooled:.1%}"

    def halves(method: str) -> str:
        groups = ("tachometers", "encoders")
        share = (sum(rate(SHOWN, method, kind, group) for kind in SINGLE) / len(SINGLE) for group in groups)
        return ", ".join(f"{group} {part:.0%}" for group, part in zip(groups, share, strict=True))

    far = {
        words: arm.real.mean(words, NETWORK, "far")
        for rate in (SHOWN, HARDER)
        for words in (rate, f"{rate} as-run", f"{rate} {FIXED} as-run", f"{rate} {NEW}")
    }
    return (
        "B, schunk: half of the runs is learned, a quarter sets the limits, the last quarter is judged; the hundred "
        "runs repeat two motions, so all motions are known. Sizes are in one-step errors of the network on healthy "
        "runs (root mean square, written σ), of a drift in such a sample; a jam begins where the next measurement "
        "would have been five away. detection_rate: the first alarm accuses the faulty sensor and no other, over "
        "stretches that were calm before; of a miss, that the sensor is unknown throughout and nobody accused. Rates "
        "are foretold without angles and angles without rates: they were smoothed offline from each other.",
        f"B, schunk: right isolation among twelve sensors at five one-step errors, with {far[SHOWN]:.1%} of healthy "
        f"samples with anybody over his limit: {each(SHOWN)}; with {far[HARDER]:.2%}: {each(HARDER)}. Residuals are "
        f"judged by their own root mean square over {DEEP.rms_ticks} samples, since some parts of the motion are "
        "harder "
        f"to foretell than others; by fixed limits, as printed ('{FIXED}'): {each(f'{SHOWN} {FIXED}')}; "
        f"{each(f'{HARDER} {FIXED}')}. One in a hundred samples is far too often for a product. As it runs, with the "
        f"accused left out, {far[f'{SHOWN} as-run']:.2%} and {far[f'{HARDER} as-run']:.2%} of healthy samples have "
        f"somebody accused ({far[f'{SHOWN} {FIXED} as-run']:.2%} and {far[f'{HARDER} {FIXED} as-run']:.2%} by fixed "
        "limits).",
        f"B, schunk: of the same faults, at the same rate of false alarms, the network isolates {halves(NETWORK)}, "
        f"linear extrapolation {halves(EXTRAPOLATION)}: angles are written with five digits, below which nobody sees; "
        "rates turn with the torques, which only the network is told. Of this arm there is no model, so the Kalman "
        "filter cannot run here.",
        f"B, schunk, {NEW}: learned and limited on the one motion, judged on the other, the network's scores pass the "
        f"limits of {SHOWN} in {far[f'{SHOWN} {NEW}']:.0%} of the healthy samples, those of {HARDER} in "
        f"{far[f'{HARDER} {NEW}']:.0%}; of the stretches that are calm it isolates {each(f'{SHOWN} {NEW}')}. The "
        "healthy runs must hold the motions that will be watched.",
    )
