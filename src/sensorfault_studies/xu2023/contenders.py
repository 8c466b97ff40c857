"""The methods of table 2 and ours, each as the monitor of a mission."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.methods.ranging.anfis_cubature import anfis
from sensorfault.methods.ranging.chi_square_cubature import chi_square
from sensorfault.methods.ranging.cooperative import REPEATED, cooperative
from sensorfault.methods.ranging.double_threshold import double_threshold
from sensorfault.methods.ranging.logistic_cubature import logistic
from sensorfault.methods.ranging.range_filter import GROWTH, Filter, cubature, followed, monitor, on_ranges
from sensorfault.methods.ranging.ranges_learned import learned
from sensorfault.stages.statistic.repeats import Repeats
from sensorfault.training.fuzzy import Setting
from sensorfault.training.labelled import joined
from sensorfault.training.ranges import Lesson
from sensorfault.vehicles.underwater import FollowerRoles
from sensorfault_studies.xu2023.scenario import TRAINED_S, Scenario

POOLED = Setting(log=True, epochs=20)  # chosen on development missions; the paper's own is the default
ALONE, POOL_OF_MISSIONS, GIVEN = "one-mission", "pooled", "given-noise"
AGAINST = "chi-square-ckf-05"
RIVAL = "chi-square-ackf-01"

Make = Callable[[Scenario], Monitor]


@dataclass(frozen=True)
class Contender:
    """A method in a variant (`words`); `make` fits its monitor on the training part of a mission."""

    name: str
    words: str
    make: Make


def early(case: Scenario) -> Lesson:
    """The training part, with the error of every range from GPS."""
    rows = case.log.time < TRAINED_S
    return Lesson(case.log.between(end_s=TRAINED_S), case.error[rows])


def contenders(q: float, sigma_m: float, pool: Sequence[Scenario]) -> tuple[Contender, ...]:
    """All methods with this process noise [m²/s] and range noise [m]; the pooled ones are trained on `pool`."""
    plain, adaptive = Filter(q, sigma_m, adaptive=False), Filter(q, sigma_m)
    log = pool[0].log
    found = followed("xu2023", log)
    many = learned(log, found, adaptive, [early(case) for case in pool])
    both = [joined(many)] * len(many)
    trained = double_threshold("double-threshold", log, found, plain, [early(case) for case in pool]).monitor
    rules = anfis("anfis-cubature-9m", log, found, adaptive, both, False, POOLED).monitor
    odds = logistic("logistic-cubature", log, found, adaptive, both).monitor
    whole = Filter(q, sigma_m, growth=GROWTH, repeated=REPEATED)

    def own(case: Scenario, rmse: bool) -> Monitor:
        mine = learned(case.log, found, adaptive, [early(case)])
        return anfis("anfis-cubature", case.log, found, adaptive, mine, rmse).monitor

    gates = [
        Contender(f"chi-square-{name}-{f'{far:.2f}'[2:]}", "", _gate(filter, far))
        for name, filter in (("ckf", plain), ("ackf", adaptive))
        for far in (0.05, 0.01)
    ]
    return (
        *gates,
        Contender("repeats-or-chi-square", "", lambda case: _with_repeats(case, found, adaptive)),
        Contender("double-threshold", POOL_OF_MISSIONS, lambda case: trained),
        Contender("anfis-cubature", ALONE, lambda case: own(case, True)),
        Contender("anfis-cubature-9m", ALONE, lambda case: own(case, False)),
        Contender("anfis-cubature-9m", POOL_OF_MISSIONS, lambda case: rules),
        Contender("logistic-cubature", POOL_OF_MISSIONS, lambda case: odds),
        Contender("cooperative", GIVEN, lambda case: cooperative("cooperative", early(case).log, whole).monitor),
        Contender("cooperative", "", lambda case: cooperative("cooperative", early(case).log).monitor),
        Contender("ungated-ackf", "", lambda case: monitor(case.log, cubature(case.log, found, adaptive))),
    )


def _gate(filter: Filter, far: float) -> Make:
    return lambda case: chi_square("chi-square", early(case).log, far, filter).monitor


def _with_repeats(case: Scenario, found: FollowerRoles, filter: Filter) -> Monitor:
    """The χ² gate at 0.01, or one exact repeat."""
    gate = chi_square("chi-square", early(case).log, 0.01, filter).monitor
    repeats = Branch(Repeats(len(case.log.channels)), on_ranges(case.log, found, 0.5), certain=True)
    return replace(gate, branches=(*gate.branches, repeats))


def eased(of: Monitor, times: float) -> Monitor:
    """The monitor with the limit of its first test multiplied by a factor; log odds are shifted on their own scale."""

    def easier(limit: object) -> object:
        now = jnp.asarray(limit)
        return jnp.where(now > 0, now * times, now + 4 * jnp.log(times))

    made: Monitor = eqx.tree_at(lambda m: m.branches[0].threshold.limit, of, replace_fn=easier)
    return made
