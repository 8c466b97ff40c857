"""Learned rules: from how much data, and what they look like."""

import numpy as np

from sensorfault.methods.ranging.anfis_cubature import RULES
from sensorfault.methods.ranging.range_filter import Filter, followed
from sensorfault.methods.ranging.ranges_learned import learned
from sensorfault.numerics.innovation import FEATURES
from sensorfault.training.fuzzy import fit_anfis
from sensorfault.training.labelled import Labelled, joined
from sensorfault.training.ranges import Lesson
from sensorfault.training.rules import sentences
from sensorfault_studies.findings import Effort, Figure, Findings
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023.contenders import POOLED, early
from sensorfault_studies.xu2023.learners import compared, curves
from sensorfault_studies.xu2023.learning_figures import features, learning, memberships, surface
from sensorfault_studies.xu2023.scenario import WRONG_M, Scenario, scenario

Q = 0.2
POOL, SEEN = 300, 1000  # first seeds of the training and test missions


def findings(effort: Effort) -> Findings:
    """Open loop: every range is used, as in the training of the paper."""
    effort.progress("rules from many and from few ranges", 0.0)
    many = 3 if effort.quick else 8
    pool, seen = ([scenario(first + k) for k in range(many)] for first in (POOL, SEEN))
    numbers = Numbers("E-rules", "simulated", "simulated")
    learn, test = (_labelled([early(case) for case in pool], True), _labelled([_late(case) for case in seen], True))
    compared(numbers, "Q0.2 open-loop pooled", joined(learn), joined(test), WRONG_M)
    for one, own in zip(seen, [_labelled([early(case)], True) for case in seen], strict=True):
        compared(numbers, "Q0.2 open-loop one-mission", joined(own), joined(_labelled([_late(one)], True)), WRONG_M)
    curves(numbers, "Q0.2 open-loop", joined(learn), joined(test), WRONG_M, draws=2 if effort.quick else 5)
    rows = tuple(numbers.rows())
    figures = []
    for j in range(2):
        fit = fit_anfis(*learn[j], RULES)
        figures += [
            memberships(f"e-rules_memberships{j + 1}", f"Membership functions of ANFIS-{j + 1}", fit.start, fit.model),
            surface(
                f"e-rules_surface{j + 1}", f"Error of a range to leader {j + 1} over its features", fit.model, learn[j]
            ),
        ]
    figures.append(_features(pool[0]))
    figures.append(learning("e-rules_learning", "Learning curves", rows))
    rules_in_words = sentences(fit_anfis(*joined(learn), POOLED).model, FEATURES)
    remark = "Rules learned from eight missions, both leaders, on logarithms of the features: " + " ".join(
        rules_in_words
    )
    return Findings(rows, tuple(figures), (remark,))


def _late(case: Scenario) -> Lesson:
    """The test part of a run through the whole mission."""
    return Lesson(case.log, np.where(case.judged[:, None], case.error, np.nan))


def _labelled(lessons: list[Lesson], adaptive: bool) -> list[Labelled]:
    log = lessons[0].log
    return learned(log, followed("xu2023", log), Filter(Q, 3.0, adaptive), lessons)


def _features(case: Scenario) -> Figure:
    """The features of the first leader in the training part."""
    lesson = early(case)
    plain, adaptive = (_labelled([lesson], kind)[0] for kind in (False, True))
    at = lesson.log.time[~np.isnan(lesson.error[:, 0])][-len(plain.target) :]
    title = "Features of the ranges to leader 1, by both filters"
    return features("e-rules_features", title, at, plain.target, plain.features, adaptive.features)
