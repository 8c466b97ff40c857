"""What the numbers do not say by themselves."""

from collections.abc import Sequence

import numpy as np

from sensorfault_studies.multistep.contenders import HORIZON_S, KINEMATIC, NETWORK
from sensorfault_studies.multistep.drift import (
    ADAPTIVE,
    CLOSED,
    DRIFT,
    HARD,
    MATCHED,
    PRINTED,
    WHOLE,
    Drift,
)
from sensorfault_studies.multistep.flown import EVERY_S, FAULTY_S

FEW, MANY, LONGEST = 1, 12, 25  # steps: the conventional observer, the paper's best, 5 s


def remarks(result: Sequence[Drift]) -> tuple[str, ...]:
    """In the order of the tables."""
    first, *others = result
    return (_reading(first), _printed(first), _matched(first), _closed(first), *(_other(one) for one in others))


def _reading(result: Drift) -> str:
    return (
        f"D: 70 % of the flight is learned from and sets all limits but those of {MATCHED}, the rest is judged. Ramps "
        f"begin every {EVERY_S:g} s (150 steps at 5 Hz) and last {FAULTY_S:g} s or to the end of the flight; a step "
        "that cannot be tested is not flagged, a ramp without an alarm counts with its whole length. chance: the "
        "same spans without a ramp. Our readings: the network foretells increments, in proportion to the time "
        "between two fixes; fusion puts all inputs side by side; all steps share their weights (separate-weights: as "
        "the paper's figure 3); steps weigh N + 1 - j; a training ends by its own loss. The paper does not say how "
        "its network was initialised, in which batches it learned, nor how its EKF was tuned."
    )


def _printed(result: Drift) -> str:
    rate, chance = (_each(result, metric, PRINTED, NETWORK) for metric in ("detection_rate", "chance"))
    delay, by_chance = (_each(result, metric, PRINTED, NETWORK) for metric in ("delay_steps", "chance_delay_steps"))
    far = [result.real.mean(f"{PRINTED} N{n}", NETWORK, "far") for n in (FEW, MANY)]
    return (
        f"D, {result.data}, {PRINTED} (a = b = 1): from N = {FEW} to N = {MANY} the first alarm comes after "
        f"{delay[0]:.0f} and {delay[1]:.0f} steps (the paper: 134 and 16), {rate[0]:.1%} and {rate[1]:.1%} of the "
        f"faulty steps are flagged (33.4 % and 65.5 %). So do {far[0]:.1%} and {far[1]:.1%} of the steps of the "
        f"healthy flight, and without any ramp the first alarm comes after {by_chance[0]:.0f} and {by_chance[1]:.0f} "
        f"steps, with {chance[0]:.1%} and {chance[1]:.1%} flagged: the limit knows nothing of N, the residual grows "
        "with it. The paper prints no rate of false alarms."
    )


def _matched(result: Drift) -> str:
    def pair(method: str, condition: str, steps: tuple[int, ...]) -> str:
        found = [result.injected.mean(f"{condition} N{n}", method, "detection_rate", DRIFT) for n in steps]
        late = [result.injected.mean(f"{condition} N{n}", method, "delay_steps", DRIFT) for n in steps]
        return " / ".join(f"{r:.0%} after {d:.0f} steps" for r, d in zip(found, late, strict=True) if np.isfinite(r))

    steps = (FEW, MANY, LONGEST)
    far = [result.real.mean(f"{HARD} N{n}", KINEMATIC, "far") for n in steps]
    return (
        f"D, {result.data}, at one rate of false alarms, N = {FEW}, {MANY} and, without a network, {LONGEST}: limits "
        f"that 1 % of the steps learned from pass ({HARD}): kinematic {pair(KINEMATIC, HARD, steps)}, network "
        f"{pair(NETWORK, HARD, steps)}; over the whole flight ({WHOLE}) kinematic "
        f"{pair(KINEMATIC, f'{HARD} {WHOLE}', steps)}. The part judged is calmer "
        f"({', '.join(f'{x:.1%}' for x in far)} of its healthy steps pass the kinematic limits), so once more with "
        f"limits that 1 % of its own healthy steps pass ({MATCHED}, for comparison only): kinematic "
        f"{pair(KINEMATIC, MATCHED, steps)}, network {pair(NETWORK, MATCHED, steps)}. A longer roll-out finds more "
        "where its inputs can be trusted; the network's own error grows nearly as fast as a ramp does: "
        f"{_rms(result, NETWORK)} m root mean square at N = {FEW} and {MANY}, the receiver's vertical speed alone "
        f"{_rms(result, KINEMATIC)} m. That speed and the height are of one receiver: a fault of both is seen by "
        "neither."
    )


def _closed(result: Drift) -> str:
    def both(metric: str, condition: str, method: str) -> str:
        return " and ".join(f"{x:.0%}" for x in _each(result, metric, condition, method))

    adaptive = f"{HARD} {ADAPTIVE}"
    closed = f"{adaptive} {CLOSED}"
    return (
        f"D, {result.data}, {CLOSED}: a height that alarms starts no roll-out; what was rolled out stands in for up "
        f"to {HORIZON_S:g} s. With N = {FEW} and {MANY} the kinematic observer then flags "
        f"{both('detection_rate', closed, KINEMATIC)} instead of {both('detection_rate', adaptive, KINEMATIC)} of the "
        f"faulty steps, the network {both('detection_rate', closed, NETWORK)} instead of "
        f"{both('detection_rate', adaptive, NETWORK)}; but a false alarm lasts as long too: "
        f"{both('chance', closed, KINEMATIC)} and {both('chance', closed, NETWORK)} of the same steps without a ramp."
    )


def _other(result: Drift) -> str:
    far = result.real.mean(f"{HARD} N{MANY}", NETWORK, "far")
    rate, chance = (_each(result, metric, MATCHED, NETWORK)[1] for metric in ("detection_rate", "chance"))
    steps = (FEW, MANY, LONGEST)
    found = [result.injected.mean(f"{HARD} {WHOLE} N{n}", KINEMATIC, "detection_rate", DRIFT) for n in steps]
    (network,) = [one for one in result.contenders if one.trained and not one.variant]
    learned = np.mean([network.typical[k] for k in network.of(MANY)])
    own, plain = (result.real.mean(f"N{MANY}", method, "rms") for method in (NETWORK, KINEMATIC))
    return (
        f"D, {result.data}: fixes at 1 Hz, so N steps are N seconds; {network.flown.start} fixes to learn from and few "
        f"ramps to judge. With N = {MANY} the network errs by {learned:.1f} m on the part it learned from and by "
        f"{own:.1f} m on the part judged, the mean of the vertical speeds at both ends of a second by {plain:.1f} m: "
        f"it has learned this flight, not how an aircraft climbs. Its limits do not hold ({HARD}: {far:.0%} of the "
        f"healthy steps judged pass them), and at {MATCHED} it flags {rate:.1%}, by chance {chance:.1%}. Over the "
        f"whole flight the kinematic observer flags {', '.join(f'{x:.0%}' for x in found)} with N = "
        f"{', '.join(map(str, steps))}."
    )


def _each(result: Drift, metric: str, condition: str, method: str) -> list[float]:
    return [result.injected.mean(f"{condition} N{n}", method, metric, DRIFT) for n in (FEW, MANY)]


def _rms(result: Drift, method: str) -> str:
    return " and ".join(f"{result.real.mean(f'N{n}', method, 'rms'):.2f}" for n in (FEW, MANY))
