"""What the numbers of the drive and of the rides say, in sentences."""

from collections.abc import Iterator

from sensorfault_studies.numbers import Numbers
from sensorfault_studies.wang2023.contenders import CHI_SQUARE, LOF, NONE, OURS
from sensorfault_studies.wang2023.drives import EQUAL, HEAVY, INFLATED, PRINTED, RATE
from sensorfault_studies.wang2023.rides import WORDS

LIKE = 1.5  # rates further apart than so many times are no one rate
STEPS = 15.0


def of_drives(numbers: Numbers, quick: bool) -> tuple[str, ...]:
    """How the study was made, where the paper's margin comes from, and what wins."""
    return tuple(_of_drives(numbers, quick))


def _of_drives(numbers: Numbers, quick: bool) -> Iterator[str]:
    yield (
        "Track and inertial unit of drive0708 are real, satellites, clock and noise are simulated. The hour of the sky "
        "and the free numbers of the heavy noise were chosen so that a limit on each innovation finds what a "
        "forerunner of this study found; the windows of train and its rule of who is spoilt on other seeds than these."
    )
    if quick:
        yield "A quick look: few runs of errors, limits of few healthy ones, 15 m for all steps."
    words = f"{INFLATED.words} {PRINTED}"
    one, other = ((numbers.mean(words, m, "detection_rate", "step", STEPS)) for m in (CHI_SQUARE, LOF))
    far = numbers.mean(words, LOF, "far")
    equal = f"{INFLATED.words} {EQUAL}"
    same = [numbers.mean(equal, m, "detection_rate", "step", STEPS) for m in (CHI_SQUARE, LOF)]
    yield (
        f"The paper's margin, a step of 15 m: with noise taken for twice as large as it is, chi-square at the "
        f"textbook's limit flags {one:.0%} of the epochs and lof-efd {other:.0%}; but with false alarms in {far:.0%} "
        f"of the healthy epochs, where a kernel density promised 1 %. At one rate they flag {same[0]:.0%} and "
        f"{same[1]:.0%}: a local outlier factor of one number is a limit on that number."
    )
    textbook = f"{HEAVY.words} {PRINTED}"
    aime = ", ".join(f"{numbers.mean(textbook, f'aime-{w}', 'far'):.0%}" for w in (10, 30, 60))
    yield (
        f"Averaged innovations at the textbook's limit raise false alarms in {aime} of the healthy epochs (10, 30, "
        "60 s): noise that lasts is no white noise. Where so much is left out the filter runs away; a position "
        "further off than a kilometre counts as a kilometre off."
    )
    apart = [
        f"{key.method} {values[0]:.2%}"
        for key, values in numbers.values.items()
        if key.condition == f"{HEAVY.words} {EQUAL}"
        and key.metric == "far"
        and not RATE / LIKE < sum(values) / len(values) < RATE * LIKE
    ]
    if apart:
        yield (
            f"Not at the rate that was asked for on other healthy runs, so not to be compared: {', '.join(apart)} "
            "(raw innovations have no one limit: low satellites are louder)."
        )
    yield _best(numbers)


def _best(numbers: Numbers) -> str:
    """Where ours stands beside the best of the others, column by column."""
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
        f"Share of the epochs that train flags, at one rate of false alarms: {'; '.join(found)}. What wins is memory "
        "and a filter that the satellite in question has not led astray; no method leads every column."
    )


def of_rides(numbers: Numbers) -> tuple[str, ...]:
    """What a user would see."""
    result = ", ".join(
        f"{method} {numbers.mean(WORDS, method, 'false_alarms_per_hour'):.0f}" for method in (CHI_SQUARE, LOF, OURS)
    )
    return (
        f"False alarms an hour on simulated rides of a train, with the limits that each recipe sets itself: {result}. "
        "train promises one; ten minutes a ride cannot show it.",
    )
