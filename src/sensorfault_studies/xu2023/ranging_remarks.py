"""Remarks on the numbers of real ranges."""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool

from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023.gates import ALL, FITTED, MATCHED, RATE, Watched

OURS, RIVAL, OPEN = "cooperative", "chi-square-ackf-01", "ungated-ackf"


def of_walks(numbers: Numbers, every: Sequence[Watched]) -> str:
    """Radio among pedestrians."""
    wrong = sum(int((one.case.wrong & one.case.judged[:, None]).sum()) for one in every)
    ranges = sum(int((~np.isnan(one.case.error) & one.case.judged[:, None]).sum()) for one in every)
    p95 = {m: numbers.mean(f"{ALL} {FITTED}", m, "error_p95_m") for m in ("ungated-ckf", OPEN, OURS)}
    recall = {m: numbers.mean(f"{ALL} {FITTED}", m, "recall") for m in ("chi-square-ckf-01", RIVAL, OURS)}
    recalls = ", ".join(f"{method} {value:.3f}" for method, value in recall.items())
    return (
        f"E, uwb_outdoor, real: {len(every)} walks. {wrong} of {ranges} test ranges are wrong by more than five robust "
        "standard deviations of their anchor. The first third of each walk gives the clock lag, the height of the "
        "tag, these standard deviations and the noise of the filters. There is no odometry: the follower is a random "
        f"walk. Recall with fitted limits and similar false alarm rates: {recalls}; the missed ranges are wrong by "
        "less than a metre. For the position the adaptive R alone is as good as the gates: 95 % of the errors are "
        f"below {p95[OPEN]:.1f} m without a gate, {p95[OURS]:.1f} m with cooperative, and {p95['ungated-ckf']:.1f} m "
        "for the plain filter without a gate."
    )


def of_dive(numbers: Numbers, groups: Mapping[str, Bool[np.ndarray, "T L"]]) -> str:
    """Sound under water."""

    def refused(words: str, method: str = OURS) -> float:
        return numbers.mean(f"{words} {FITTED}".strip(), method, "rejected_fraction")

    return (
        "E, ugps_g2, real: no truth, so consistency but no detection rate. The receivers' positions are fitted to the "
        "device's own positions in the first half; the ranges of the second half are tested. valid_r only says "
        f"whether there is a range. {int(groups['impossible'].sum())} ranges differ from two others by more than the "
        f"distance of the receivers and cannot be right. cooperative rejects {refused('impossible'):.2f} of these and "
        f"{refused(''):.3f} of all, {refused('weak-third'):.3f} of the weakest third and {refused('strong-third'):.3f} "
        f"of the strongest. chi-square-ackf-01 rejects {refused('', RIVAL):.3f} of all: 54 s after the start the "
        "reported depth jumps by 0.6 m and all four ranges are rejected at once; cooperative, which increases its "
        "process noise with every rejection, recovers sooner."
    )


def of_robots(real: Numbers, injected: Numbers) -> str:
    """Barcodes on a floor."""

    def rate(method: str, words: str, metric: str, numbers: Numbers = real, fault: str | None = None) -> float:
        return numbers.mean(f"{ALL} {words}", method, metric, fault)

    found = ", ".join(
        f"{method} {rate(method, MATCHED, 'recall', injected, 'frozen'):.2f} and "
        f"{rate(method, MATCHED, 'recall', injected, 'drift'):.2f} at a false alarm rate of "
        f"{rate(method, MATCHED, 'fpr', injected):.3f}"
        for method in (RIVAL, OURS)
    )
    return (
        "E, mrclam, real: the noise comes from the truth of each robot's first third, because the maximum-likelihood "
        "noise is far too small: the error of a range to one landmark hardly changes for seconds. Therefore the "
        f"nominal 0.01 becomes {rate(RIVAL, FITTED, 'fpr'):.2f} ({RIVAL}) and {rate(OURS, FITTED, 'fpr'):.2f} ({OURS}) "
        f"of the healthy ranges, and the gates make the position worse: {rate(OPEN, FITTED, 'error_p95_m'):.1f} m "
        f"without, {rate(RIVAL, FITTED, 'error_p95_m'):.1f} and {rate(OURS, FITTED, 'error_p95_m'):.1f} m with them "
        f"(95 %). Limits that {RATE:.1%} of the healthy ranges of the first thirds exceed ({MATCHED}) do not. With one "
        "landmark after the other frozen or drifting by 0.05 m/s for a minute, recall for frozen and drift is: "
        f"{found}. After a faulty range is used, correct ranges are rejected, so the false alarm rates differ."
    )
