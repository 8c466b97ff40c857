"""Experiment C, condition (b): a simulated train as a user sees it: fit on one ride, detect on others."""

from sensorfault.evaluation.judge import judge
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.epochs import RANGE
from sensorfault.logs.table import Log
from sensorfault.methods.fit import fit
from sensorfault.runtime.detect import detect
from sensorfault.simulation.train import ride
from sensorfault_studies.findings import Effort
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.wang2023.contenders import CHI_SQUARE, LOF, OURS

METHODS = (CHI_SQUARE, LOF, OURS)
TRAINING, FIRST, RIDES = 500, 510, 3  # seed of the training ride, first seed and number of the test rides
LONG_S, ONSET_S, LASTS_S = 600.0, 300.0, 80.0
FAULTS = (("offset", 15.0), ("offset", 30.0), ("drift", 0.5), ("drift", 2.0))
WORDS = "tunnels, as fitted"


def rides(numbers: Numbers, effort: Effort) -> None:
    """Detection by each recipe with the limits that it sets itself, and its false alarms on a healthy ride."""
    training = ride(LONG_S, TRAINING).log
    logs = [ride(LONG_S, FIRST + k).log for k in range(1 if effort.quick else RIDES)]
    for k, method in enumerate(METHODS):
        effort.progress(f"rides: {method}", k / len(METHODS))
        model = fit(training, method, held_out=0.0)
        for seed, log in enumerate(logs):
            alarms = len(detect(model, log).events)
            numbers.add(WORDS, method, {"false_alarms_per_hour": alarms / (log.duration_s / 3600)})
            satellite = _steady(log)
            for kind, size in FAULTS:
                done = inject(log, [Fault(kind, satellite, RANGE, ONSET_S, LASTS_S, size)], seed)
                (outcome,) = judge(detect(model, done.log), done.truth).outcomes
                found = {"found": float(outcome.found), "false_isolations": float(outcome.false_isolations)}
                numbers.add(WORDS, method, found | ({"delay_s": outcome.delay_s} if outcome.found else {}), kind, size)


def _steady(log: Log) -> str:
    """The satellite with the most measurements during the fault."""
    part = log.between(ONSET_S, ONSET_S + LASTS_S)
    ranges = [i for i, channel in enumerate(log.channels) if channel.name == RANGE]
    return log.channels[max(ranges, key=lambda i: int(part.fresh[:, i].sum()))].sensor
