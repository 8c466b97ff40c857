"""What the numbers of real ranges do not say by themselves."""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool

from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023.gates import ALL, FITTED, MATCHED, RATE, Watched

OURS, RIVAL, OPEN = "cooperative", "chi-square-ackf-01", "ungated-ackf"


def of_walks(numbers: Numbers, every: Sequence[Watched]) -> str:
    """Radio among walkers."""
    wrong = sum(int((one.case.wrong & one.case.judged[:, None]).sum()) for one in every)
    ranges = sum(int((~np.isnan(one.case.error) & one.case.judged[:, None]).sum()) for one in every)
    p95 = {m: numbers.mean(f"{ALL} {FITTED}", m, "error_p95_m") for m in ("ungated-ckf", OPEN, OURS)}
    recall = {m: numbers.mean(f"{ALL} {FITTED}", m, "recall") for m in ("chi-square-ckf-01", RIVAL, OURS)}
    said = ", ".join(f"{method} {value:.3f}" for method, value in recall.items())
    return (
        f"E, uwb_outdoor, real: {len(every)} walks, {wrong} of {ranges} judged ranges are more than five robust "
        "standard deviations of their anchor off; of each walk the first third gives the clocks' lag, the tag's "
        "height, these standard deviations and the noise of the filters. Nobody measures where the walker goes: the "
        f"follower is a random walk. Recall, limits as fitted and rates of false alarms alike: {said}; what is missed "
        "is off by less than a metre. The adaptive R alone does what the gates do for the position: 95 % of its errors "
        f"are below {p95[OPEN]:.1f} m without a gate, {p95[OURS]:.1f} m with cooperative, {p95['ungated-ckf']:.1f} m "
        "on the plain filter without a gate."
    )


def of_dive(numbers: Numbers, groups: Mapping[str, Bool[np.ndarray, "T L"]]) -> str:
    """Sound under water."""

    def refused(words: str, method: str = OURS) -> float:
        return numbers.mean(f"{words} {FITTED}".strip(), method, "rejected_fraction")

    return (
        "E, ugps_g2, real, no truth, so consistency and no rate of detection: the receivers' places are fitted to the "
        "device's own positions in the first half, the ranges of the second are judged. valid_r says no more than "
        f"whether there is a range. {int(groups['impossible'].sum())} ranges differ from two others by more than the "
        f"receivers are apart and cannot be right; cooperative refuses {refused('impossible'):.2f} of these and "
        f"{refused(''):.3f} of all, {refused('weak-third'):.3f} of the weakest third and {refused('strong-third'):.3f} "
        f"of the strongest. chi-square-ackf-01 refuses {refused('', RIVAL):.3f} of all: 54 s after the start the told "
        "depth steps by 0.6 m and all four ranges are refused at once; cooperative, which doubts its own way the more "
        "the more it refuses, is back sooner."
    )


def of_robots(real: Numbers, injected: Numbers) -> str:
    """Barcodes on a floor."""

    def rate(method: str, words: str, metric: str, numbers: Numbers = real, fault: str | None = None) -> float:
        return numbers.mean(f"{ALL} {words}", method, metric, fault)

    found = ", ".join(
        f"{method} {rate(method, MATCHED, 'recall', injected, 'jam'):.2f} and "
        f"{rate(method, MATCHED, 'recall', injected, 'drift'):.2f} at a rate of false alarms of "
        f"{rate(method, MATCHED, 'fpr', injected):.3f}"
        for method in (RIVAL, OURS)
    )
    return (
        "E, mrclam, real: the noises are what the truth of each robot's first third says, because the likeliest ones "
        "are far too small: the error of a range to one landmark hardly changes for seconds. So the nominal .01 is "
        f"{rate(RIVAL, FITTED, 'fpr'):.2f} ({RIVAL}) and {rate(OURS, FITTED, 'fpr'):.2f} ({OURS}) of the healthy "
        f"ranges, and the gates do the position harm: {rate(OPEN, FITTED, 'error_p95_m'):.1f} m without, "
        f"{rate(RIVAL, FITTED, 'error_p95_m'):.1f} and {rate(OURS, FITTED, 'error_p95_m'):.1f} m with them (95 %). "
        f"Limits that {RATE:.1%} of the healthy ranges of the first thirds pass ({MATCHED}) do not. Injected, one "
        "landmark after the other frozen or drifting by 0.05 m/s for a minute: of the ranges that a jam and a drift "
        f"make wrong are found, {found}; once a lie is taken in, right ranges are refused, and the rates part."
    )
