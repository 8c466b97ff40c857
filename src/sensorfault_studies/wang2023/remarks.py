"""Remarks on the numbers of the drive and of the rides."""

from collections.abc import Iterator

from sensorfault_studies.numbers import Numbers
from sensorfault_studies.wang2023.contenders import CHI_SQUARE, LOF, NONE, OURS
from sensorfault_studies.wang2023.drives import EQUAL, HEAVY, INFLATED, PRINTED, RATE
from sensorfault_studies.wang2023.rides import WORDS

LIKE = 1.5  # rates that differ by more than this factor are not compared
STEPS = 15.0


def of_drives(numbers: Numbers, quick: bool) -> tuple[str, ...]:
    """The setup of the study, the cause of the paper's difference, and the best method."""
    return tuple(_of_drives(numbers, quick))


def _of_drives(numbers: Numbers, quick: bool) -> Iterator[str]:
    yield (
        "Track and inertial unit of drive0708 are real; satellites, clock and noise are simulated. The time of day "
        "and the free parameters of the heavy noise were chosen so that a limit on each innovation reproduces an "
        "earlier version of this study; the windows and the attribution rule of rail were chosen on other seeds."
    )
    if quick:
        yield "A quick run: few runs with faults, limits from few healthy runs, 15 m in place of all steps."
    words = f"{INFLATED.words} {PRINTED}"
    one, other = ((numbers.mean(words, m, "detection_rate", "step", STEPS)) for m in (CHI_SQUARE, LOF))
    far = numbers.mean(words, LOF, "far")
    equal = f"{INFLATED.words} {EQUAL}"
    same = [numbers.mean(equal, m, "detection_rate", "step", STEPS) for m in (CHI_SQUARE, LOF)]
    yield (
        "The paper's difference, for a step of 15 m: if the filter assumes twice the true noise, chi-square at the "
        f"textbook limit flags {one:.0%} of the epochs and lof-efd {other:.0%}, but lof-efd has false alarms in "
        f"{far:.0%} of the healthy epochs, where its kernel density is set for 1 %. At a common false alarm rate they "
        f"flag {same[0]:.0%} and {same[1]:.0%}: a local outlier factor of a single number is a limit on that number."
    )
    textbook = f"{HEAVY.words} {PRINTED}"
    aime = ", ".join(f"{numbers.mean(textbook, f'aime-{w}', 'far'):.0%}" for w in (10, 30, 60))
    yield (
        f"Averaged innovations at the textbook limit raise false alarms in {aime} of the healthy epochs (10, 30, 60 "
        "s), because the noise is not white. With so many exclusions the filter diverges; position errors above a "
        "kilometre count as a kilometre."
    )
    off_rate = [
        f"{key.method} {values[0]:.2%}"
        for key, values in numbers.values.items()
        if key.condition == f"{HEAVY.words} {EQUAL}"
        and key.metric == "far"
        and not RATE / LIKE < sum(values) / len(values) < RATE * LIKE
    ]
    if off_rate:
        yield (
            f"Not at the designed rate on other healthy runs, so not comparable: {', '.join(off_rate)} (raw "
            "innovations need different limits, because low satellites have more noise)."
        )
    yield _best(numbers)


def _best(numbers: Numbers) -> str:
    """Our method and the best of the others, fault by fault."""
    words = f"{HEAVY.words} {EQUAL}"
    found = []
    for kind, size in (("step", 10.0), ("step", 15.0), ("ramp", 0.25), ("ramp", 0.5)):
        own = numbers.mean(words, OURS, "detection_rate", kind, size)
        rivals = {
            key.method: numbers.mean(words, key.method, "detection_rate", kind, size)
            for key in numbers.values
            if key.condition == words and key.method not in (OURS, NONE) and key.metric == "detection_rate"
        }
        if own == own and rivals:
            best = max(rivals, key=lambda name: rivals[name] if rivals[name] == rivals[name] else -1.0)
            found.append(f"{kind} {size:g}: {own:.0%}, the best other {rivals[best]:.0%} ({best})")
    return (
        f"Share of the faulty epochs that rail flags, at a common false alarm rate: {'; '.join(found)}. Memory helps, "
        "and a filter that does not use the tested satellite; no method is best for every fault."
    )


def of_rides(numbers: Numbers) -> tuple[str, ...]:
    """False alarms of the recipes as a user fits them."""
    rates = ", ".join(
        f"{method} {numbers.mean(WORDS, method, 'false_alarms_per_hour'):.0f}" for method in (CHI_SQUARE, LOF, OURS)
    )
    return (
        f"False alarms an hour on simulated rides of a train, with the limits that each recipe sets itself: {rates}. "
        "rail is designed for one; rides of ten minutes are too short to verify that.",
    )
