"""Remarks on the numbers of experiment D."""

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
        f"D: 70 % of the flight is for training and sets all limits except those of {MATCHED}; the rest is the test "
        f"part. Ramps begin every {EVERY_S:g} s (150 steps at 5 Hz) and last {FAULTY_S:g} s or to the end of the "
        "flight. A step that cannot be tested has no alarm; a ramp without an alarm counts with its whole length. "
        "chance: the same spans without a ramp. Our interpretations: the network predicts increments, in proportion "
        "to the time between two fixes; fusion concatenates all inputs; all steps share their weights "
        "(separate-weights: as in the paper's figure 3); step j has weight N + 1 - j; training stops by the training "
        "loss. The paper does not give the initial weights and the batches of its network, nor the tuning of its EKF."
    )


def _printed(result: Drift) -> str:
    rate, chance = (_each(result, metric, PRINTED, NETWORK) for metric in ("detection_rate", "chance"))
    delay, by_chance = (_each(result, metric, PRINTED, NETWORK) for metric in ("delay_steps", "chance_delay_steps"))
    far = [result.real.mean(f"{PRINTED} N{n}", NETWORK, "far") for n in (FEW, MANY)]
    return (
        f"D, {result.data}, {PRINTED} (a = b = 1): from N = {FEW} to N = {MANY} the first alarm comes after "
        f"{delay[0]:.0f} and {delay[1]:.0f} steps (the paper: 134 and 16), and {rate[0]:.1%} and {rate[1]:.1%} of the "
        f"faulty steps have an alarm (the paper: 33.4 % and 65.5 %). But so do {far[0]:.1%} and {far[1]:.1%} of the "
        f"steps of the healthy flight, and without a ramp the first alarm comes after {by_chance[0]:.0f} and "
        f"{by_chance[1]:.0f} steps, with alarms on {chance[0]:.1%} and {chance[1]:.1%}: the residual grows with N, but "
        "the limit does not. The paper gives no false alarm rate."
    )


def _matched(result: Drift) -> str:
    def pair(method: str, condition: str, steps: tuple[int, ...]) -> str:
        found = [result.injected.mean(f"{condition} N{n}", method, "detection_rate", DRIFT) for n in steps]
        late = [result.injected.mean(f"{condition} N{n}", method, "delay_steps", DRIFT) for n in steps]
        return " / ".join(f"{r:.0%} after {d:.0f} steps" for r, d in zip(found, late, strict=True) if np.isfinite(r))

    steps = (FEW, MANY, LONGEST)
    far = [result.real.mean(f"{HARD} N{n}", KINEMATIC, "far") for n in steps]
    return (
        f"D, {result.data}, at a common false alarm rate, N = {FEW}, {MANY} and, without a network, {LONGEST}. Limits "
        f"that 1 % of the training steps exceed ({HARD}): kinematic {pair(KINEMATIC, HARD, steps)}, network "
        f"{pair(NETWORK, HARD, steps)}; over the whole flight ({WHOLE}) kinematic "
        f"{pair(KINEMATIC, f'{HARD} {WHOLE}', steps)}. The test part is calmer ({', '.join(f'{x:.1%}' for x in far)} "
        "of its healthy steps exceed the kinematic limits), so also with limits that 1 % of its own healthy steps "
        f"exceed ({MATCHED}, for comparison only): kinematic {pair(KINEMATIC, MATCHED, steps)}, network "
        f"{pair(NETWORK, MATCHED, steps)}. A longer roll-out detects more if its inputs can be trusted. The network's "
        f"own error grows nearly as fast as a ramp: {_rms(result, NETWORK)} m RMS at N = {FEW} and {MANY}; with the "
        f"receiver's vertical speed alone it is {_rms(result, KINEMATIC)} m. That speed and the height come from one "
        "receiver: neither observer detects a fault of both."
    )


def _closed(result: Drift) -> str:
    def both(metric: str, condition: str, method: str) -> str:
        return " and ".join(f"{x:.0%}" for x in _each(result, metric, condition, method))

    adaptive = f"{HARD} {ADAPTIVE}"
    closed = f"{adaptive} {CLOSED}"
    return (
        f"D, {result.data}, {CLOSED}: a height with an alarm starts no roll-out; the roll-out is its stand-in for at "
        f"most {HORIZON_S:g} s. With N = {FEW} and {MANY} the kinematic observer then has an alarm on "
        f"{both('detection_rate', closed, KINEMATIC)} instead of {both('detection_rate', adaptive, KINEMATIC)} of the "
        f"faulty steps, the network on {both('detection_rate', closed, NETWORK)} instead of "
        f"{both('detection_rate', adaptive, NETWORK)}. But false alarms last longer too: "
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
        f"D, {result.data}: fixes at 1 Hz, so N steps are N seconds; {network.flown.start} fixes for training and few "
        f"test ramps. With N = {MANY} the error of the network is {learned:.1f} m on the training part and {own:.1f} m "
        f"on the test part; with the mean vertical speed of both ends of a second it is {plain:.1f} m. The network has "
        f"learned this flight, not how an aircraft climbs. Its limits do not hold on the test part ({HARD}: {far:.0%} "
        f"of the healthy steps exceed them); at {MATCHED} it detects {rate:.1%} of the steps, {chance:.1%} by chance. "
        f"Over the whole flight the kinematic observer detects {', '.join(f'{x:.0%}' for x in found)} with N = "
        f"{', '.join(map(str, steps))}."
    )


def _each(result: Drift, metric: str, condition: str, method: str) -> list[float]:
    return [result.injected.mean(f"{condition} N{n}", method, metric, DRIFT) for n in (FEW, MANY)]


def _rms(result: Drift, method: str) -> str:
    return " and ".join(f"{result.real.mean(f'N{n}', method, 'rms'):.2f}" for n in (FEW, MANY))
