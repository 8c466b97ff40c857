"""Remarks on the numbers of niu1998."""

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
        f"B: the paper does not print x(0). It is chosen here so that the paper's rule (largest slope times T plus "
        f"three standard deviations of the noise) gives about its thresholds: {y2:.4f} rad/s and {y4:.4f} rad, printed "
        f"0.024 and 0.0182. Rates [rad/s] and angles [rad]: {starts}. The second input is printed as another u1 of "
        f"125 N m; 'physical' has 25 N m and a5 = 24.06. The paper does not print drift rates: here they are {FAST:g} "
        f"thresholds a sample on {SENSORS[0]} (y2) and {SENSORS[1]} (y4) from sample {ONSET} on. Magnitudes of "
        "simulated drifts are in thresholds a sample."
    )


def _seeds(effort: Effort) -> str:
    seeds, each = (1, QUICK_EACH) if effort.quick else (effort.seeds, EACH)
    return (
        f"B: a seed fixes the initial weights of a network, the healthy runs for its fit and {RUNS} noisy runs for its "
        f"test, {seeds * RUNS} test runs in all; on the real arm {each} faults of each kind and size on each sensor. "
        f"{AT_RATE}: limits that 5 % of other healthy runs exceed before sample {ONSET}. far: share of runs with an "
        "alarm before that sample. detection_rate: share of runs with both drifts detected at sample 51 or 52. "
        "untested: share of the earlier samples in which the four sensors are unknown."
    )


def _network(run: Drifts) -> str:
    variants = []
    for words in (PRINTED, f"{PRINTED} {SCRATCH}", f"{PRINTED} {AS_PRINTED}"):
        rate, far, blank = (run.numbers.mean(words, NETWORK, m, "drift") for m in ("detection_rate", "far", "untested"))
        variants.append(
            f"{rate:.0%} detected, {far:.1%} with an early alarm, {blank:.0%} of the earlier samples untested"
        )
    moved = {f"{NETWORK}{v}": (NETWORK, v) for v in ("", f" {SCRATCH}")} | {m: (m, "") for m in (*PLAIN, KALMAN)}
    elsewhere = ", ".join(
        f"{name} {run.numbers.mean(f'{PRINTED}{variant} {AT_RATE} other-start', method, 'far'):.0%}"
        for name, (method, variant) in moved.items()
    )
    return (
        f"B: the recipe, trained before on healthy runs of the same motion and learning increments: {variants[0]}. The "
        f"same with random initial weights ('{SCRATCH}'): {variants[1]}. Absolute values learned from scratch, each "
        f"sample to convergence, as in the paper ('{AS_PRINTED}'): {variants[2]}. Learning to convergence also learns "
        "the noise, so the other variants correct a prediction by a third of its error. A trained network has learned "
        f"the motion, not the arm: with the limits of {AT_RATE} and a start from {ELSEWHERE.start}, the shares of "
        f"healthy runs with an early alarm are {elsewhere}."
    )


def _plain(run: Drifts) -> str:
    found = {m: run.numbers.mean(f"{PRINTED} {AT_RATE}", m, "detection_rate", "drift") for m in (*PLAIN, KALMAN)}
    early = run.numbers.mean(PRINTED, PLAIN[0], "far", "drift")
    return (
        f"B: with the paper's thresholds persistence raises an early alarm in {early:.0%} of the runs, because the "
        "largest slope already uses up the threshold and the difference of two measurements has √2 times their noise. "
        f"At the common false alarm rate it detects both drifts as early in {found[PLAIN[0]]:.0%}, linear "
        f"extrapolation in {found[PLAIN[1]]:.0%}, and the Kalman filter with the model of the arm in "
        f"{found[KALMAN]:.0%}: a drift of two thresholds a sample needs no network. The filter is only as good as its "
        "model: with the other a5 (24.6 in place of 24.06) its recipe rejects these runs as those of another arm."
    )


def _errors(run: Drifts) -> str:
    def error(words: str, method: str) -> str:
        return f"{run.numbers.mean(words, method, 'rms_y2'):.4f}"

    errors = []
    for start in ("", " from-rest"):
        free = [
            error(f"{PRINTED}{start} {AS_PRINTED} noise-free", NETWORK),
            error(f"{PRINTED}{start} noise-free", PLAIN[0]),
            error(f"{PRINTED}{start} noise-free", NETWORK),
            error(f"{PRINTED}{start} noise-free", EXTRAPOLATION),
        ]
        errors.append(
            f"absolute values learned from scratch {free[0]}, persistence {free[1]}, increments {free[2]}, linear "
            f"extrapolation {free[3]}"
        )
    noisy = [error(PRINTED, method) for method in (NETWORK, EXTRAPOLATION, KALMAN)]
    return (
        f"B: one-step error of the second joint's rate without noise [rad/s], with the printed input: {errors[0]}; "
        f"from rest: {errors[1]}. With the paper's noise, linear extrapolation has √6 times that noise ({noisy[1]}), "
        f"the network averages ({noisy[0]}), and the filter's error is nearly that of the sensor ({noisy[2]})."
    )


def _slow(run: Drifts, effort: Effort) -> tuple[str, ...]:
    rates = QUICK if effort.quick else SLOWER
    smallest_of = []
    for y in NAMES:
        least = {}
        for variant in ("", SCRATCH):
            words = " ".join(part for part in (PRINTED, variant, AT_RATE, y) if part)
            least[f"{NETWORK} {variant}".strip()] = smallest(run.numbers, words, NETWORK, rates)
        least |= {m: smallest(run.numbers, f"{PRINTED} {AT_RATE} {y}", m, rates) for m in (*PLAIN, KALMAN)}
        each = ", ".join(f"{name} {rate:g}" if isfinite(rate) else f"{name} none" for name, rate in least.items())
        smallest_of.append(f"{y}: {each}")
    return (
        f"B: smallest tested drift that is detected within {WITHIN} samples in {FOUND:.0%} of the runs, at the common "
        f"false alarm rate [thresholds a sample]: {'; '.join(smallest_of)}. A prediction from the last measurement "
        "shows a drift only until the drift is learned: below one threshold a sample the next window already "
        "contains it, as the paper says. A filter with the model of the arm accumulates it. So does the trained "
        "network for y2, whose motion it has memorised, but not for y4, because y4 is its only information about "
        "that angle.",
    )


def _real(arm: Joints) -> tuple[str, ...]:
    def rate(words: str, method: str, kind: str, group: str = "all") -> float:
        return arm.injected.mean(f"{words} {group}", method, "detection_rate", kind, FIVE[kind])

    def by_kind(words: str) -> str:
        pooled = arm.injected.mean(f"{words} all", NETWORK, "detection_rate", " or ".join(SINGLE))
        return ", ".join(f"{kind} {rate(words, NETWORK, kind):.1%}" for kind in SINGLE) + f", all {pooled:.1%}"

    def by_group(method: str) -> str:
        groups = ("tachometers", "encoders")
        share = (sum(rate(SHOWN, method, kind, group) for kind in SINGLE) / len(SINGLE) for group in groups)
        return ", ".join(f"{group} {part:.0%}" for group, part in zip(groups, share, strict=True))

    far = {
        words: arm.real.mean(words, NETWORK, "far")
        for rate in (SHOWN, HARDER)
        for words in (rate, f"{rate} as-run", f"{rate} {FIXED} as-run", f"{rate} {NEW}")
    }
    return (
        "B, schunk: half of the runs is for training, a quarter for the limits, the last quarter for the test. The "
        "hundred runs repeat two motions, so all motions are known. Sizes are in RMS one-step errors of the network "
        "on healthy runs (written σ), of a drift in σ a sample; a frozen fault starts where the next measurement "
        "would have been 5 σ away. detection_rate: the first alarm names the faulty sensor and no other, over "
        "stretches without an earlier alarm; for missing: the sensor is unknown throughout and no sensor is named. "
        "Rates are predicted without angles and angles without rates, because both were smoothed offline from each "
        "other.",
        "B, schunk: correct isolation among twelve sensors at five one-step errors, with limits that "
        f"{far[SHOWN]:.1%} of healthy samples exceed on any sensor: {by_kind(SHOWN)}; with {far[HARDER]:.2%}: "
        f"{by_kind(HARDER)}. Residuals are divided by their own RMS over {DEEP.rms_ticks} samples, because some parts "
        f"of the motion are harder to predict than others. With fixed limits, as in the paper ('{FIXED}'): "
        f"{by_kind(f'{SHOWN} {FIXED}')}; {by_kind(f'{HARDER} {FIXED}')}. One in a hundred samples is far too often "
        f"for a product. In closed loop, with the named sensors excluded, {far[f'{SHOWN} as-run']:.2%} and "
        f"{far[f'{HARDER} as-run']:.2%} of healthy samples have an alarm ({far[f'{SHOWN} {FIXED} as-run']:.2%} and "
        f"{far[f'{HARDER} {FIXED} as-run']:.2%} with fixed limits).",
        f"B, schunk: for the same faults and the same false alarm rate, the network isolates {by_group(NETWORK)}, and "
        f"linear extrapolation {by_group(EXTRAPOLATION)}. Angles are recorded with five digits, which bounds every "
        "method; rates follow the torques, which only the network gets as inputs. There is no model of this arm, so "
        "the Kalman filter cannot run here.",
        f"B, schunk, {NEW}: with training and limits on one motion and the test on the other, the network's scores "
        f"exceed the limits of {SHOWN} in {far[f'{SHOWN} {NEW}']:.0%} of the healthy samples, and those of {HARDER} in "
        f"{far[f'{HARDER} {NEW}']:.0%}; in stretches without an earlier alarm it isolates {by_kind(f'{SHOWN} {NEW}')}. "
        "The healthy runs must contain the motions that will be monitored.",
    )
