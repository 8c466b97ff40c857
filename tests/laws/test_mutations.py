"""Every law catches what it is there for: a monitor, a runner or a file that is wrong in one way fails it."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import sensorfault.core.monitor
from laws import test_laws as laws
from laws.case import Case
from laws.guests import motion, zoo
from laws.mutants import judging, taking_in
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Sample
from sensorfault.runtime import registry
from sensorfault.runtime.encoding import encode
from sensorfault.runtime.runners import Stepper, StepResult, fleet
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.statistic.cusum import Cusum

Patch = pytest.MonkeyPatch


def put(case: Case, **parts: object) -> Case:
    """The case with other parts in its monitor."""
    return replace(case, monitor=replace(case.monitor, **parts))


def branch(case: Case, **parts: object) -> Case:
    """The case with another statistic or threshold in its first branch."""
    first, *rest = case.monitor.branches
    return put(case, branches=(replace(first, **parts), *rest))


def scaled(case: Case, times: float) -> Case:
    """The case with all limits so many times as high."""
    return branch(case, threshold=zoo.limits(float(case.monitor.branches[0].threshold.limit[0]) * times, 3))


# Monitors


def false_alarms(patch: Patch) -> Case:
    return scaled(zoo.kalman(), 0.5)


def named_is_the_next(patch: Patch) -> Case:
    return put(zoo.kalman(), decision=judging.BlamesTheNext())


def accused_is_measured(patch: Patch) -> Case:
    return put(zoo.kalman(), recovery=taking_in.TakesInTheAccused())


def motion_is_silent(patch: Patch) -> Case:
    return scaled(motion.moving(), np.inf)


def motion_gates(patch: Patch) -> Case:
    return put(motion.moving(), recovery=taking_in.MotionGates())


def all_measured_is_learned(patch: Patch) -> Case:
    return put(zoo.windowed(), recovery=taking_in.LearnsWhatItTakesIn())


def held_is_measured(patch: Patch) -> Case:
    return put(zoo.held(), recovery=taking_in.TakesHeldForNew())


def limit_learns_all(patch: Patch) -> Case:
    case = zoo.learner()
    return branch(case, threshold=judging.Gullible(case.monitor.branches[0].threshold))


def weights_learn_all(patch: Patch) -> Case:
    case = zoo.learner()
    return replace(
        put(case, residual=taking_in.LearnsItsWeights(case.monitor.residual)),
        learned=lambda state: state.residual.weights,
    )


def no_limit_is_infinite(patch: Patch) -> Case:
    return put(zoo.kalman(), decision=judging.Capped(-np.inf, 10.0))


def no_limit_is_minus_infinity(patch: Patch) -> Case:
    return put(zoo.kalman(), decision=judging.Capped(1.0, np.inf))


def missing_is_ok(patch: Patch) -> Case:
    return branch(zoo.kalman(), statistic=judging.JudgesWhatIsNotThere())


def one_silences_all(patch: Patch) -> Case:
    return branch(zoo.kalman(), statistic=judging.AllOrNothing())


def nan_stays(patch: Patch) -> Case:
    patch.setattr(sensorfault.core.monitor, "keep_finite", lambda new, old: new)
    made = zoo.inertial(careful=False)
    parts = {field.name: getattr(made, field.name) for field in fields(made)}
    return replace(zoo.block(), monitor=taking_in.KeepsAnything(**parts))


def order_counts(patch: Patch) -> Case:
    def build(order: object = (0, 1, 2)) -> Monitor:
        made = zoo.three_positions(order)
        return replace(made, branches=(replace(made.branches[0], statistic=judging.Ranked()),))

    return replace(zoo.kalman(), monitor=build(), permuted=build)


def each_number_compiles(patch: Patch) -> Case:
    return branch(zoo.kalman(), threshold=judging.PlainNumber(3.0))


def window_stays_broken(patch: Patch) -> Case:
    case = zoo.learner()
    return put(case, residual=taking_in.NeverRefills(case.monitor.residual))


def offended_by_a_gap(patch: Patch) -> Case:
    return branch(zoo.kalman(), statistic=judging.Offended())


def summed(ceiling: float) -> Case:
    """A cumulative sum beside the instant test, which stops at a ceiling."""
    each = jnp.full(3, 0.5)
    sums = Branch(Cusum(each, ceiling * jnp.ones(3), jnp.asarray(1.0, float)), zoo.limits(14.0, 3), gates=False)
    made = zoo.three_positions(branches=(sums,), most=0)
    return replace(zoo.kalman(), name="summed", monitor=made, back_s=1.0)


def sum_without_a_ceiling(patch: Patch) -> Case:
    return summed(np.inf)


def blind_after_a_fault(patch: Patch) -> Case:
    return branch(zoo.kalman(), statistic=judging.Habituated(3))


def never_readmitted(patch: Patch) -> Case:
    return put(zoo.learner(), recovery=Rebuild(jnp.asarray(0.5, float), jnp.asarray(1e9, float), 2))


def alarms_too_often(patch: Patch) -> Case:
    return scaled(zoo.kalman(), 0.8)


def alarms_too_seldom(patch: Patch) -> Case:
    return scaled(zoo.kalman(), 1.3)


# Runners and files


class AllIsNew(Stepper):
    """A live step that drops `fresh`."""

    def push(self, time: float, value: object, fresh: object = True, block: object = (), born: object = False):
        return super().push(time, value, True, block, born)


def live_drops_fresh(patch: Patch) -> Case:
    patch.setattr(laws, "Stepper", AllIsNew)
    return zoo.held()


class LastWord(Stepper):
    """A live step that answers with what it said of the sample before."""

    def push(self, *row: object) -> StepResult:
        before, self._said = getattr(self, "_said", None), super().push(*row)
        return before or self._said


def live_is_late(patch: Patch) -> Case:
    patch.setattr(laws, "Stepper", LastWord)
    return zoo.kalman()


def fleet_mixes_vehicles(patch: Patch) -> Case:
    def mixed(monitor: Monitor, states: object, rows: Sample, keep: Callable) -> tuple:
        states, result = fleet(monitor, states, rows, keep)
        return states, jax.tree.map(lambda x: jnp.roll(x, 1, axis=0), result)

    patch.setattr(laws, "fleet", mixed)
    return zoo.kalman()


def fleet_forgets(patch: Patch) -> Case:
    patch.setattr(laws, "fleet", lambda monitor, states, rows, keep: (states, fleet(monitor, states, rows, keep)[1]))
    return zoo.pairs()


def saving_loses_digits(patch: Patch) -> Case:
    def rounded(part: object, name: str, tensors: dict[str, np.ndarray]) -> object:
        header = encode(part, name, tensors)
        tensors |= {key: x.astype(np.float32).astype(x.dtype) for key, x in tensors.items()}
        return header

    patch.setattr(laws, "encode", rounded)
    return zoo.kalman()


def saving_loses_a_setting(patch: Patch) -> Case:
    def shortened(part: object, name: str, tensors: dict[str, np.ndarray]) -> object:
        header = encode(part, name, tensors)
        del header["fields"]["most"]
        return header

    patch.setattr(laws, "encode", shortened)
    return zoo.kalman()


def saving_takes_anything(patch: Patch) -> Case:
    patch.setattr(laws, "encode", lambda part, name, tensors: {})
    return zoo.kalman()


@dataclass(frozen=True)
class Mutation:
    law: Callable[..., None]
    made: Callable[[Patch], Case]
    more: tuple[object, ...] = ()

    def __str__(self) -> str:
        return self.made.__name__


MUTATIONS = (
    Mutation(laws.test_healthy_is_ok_and_a_lie_is_named, false_alarms),
    Mutation(laws.test_healthy_is_ok_and_a_lie_is_named, named_is_the_next),
    Mutation(laws.test_healthy_is_ok_and_a_lie_is_named, accused_is_measured),
    Mutation(laws.test_healthy_motion_is_ok_and_a_lie_about_it_is_its_fault, motion_is_silent),
    Mutation(laws.test_healthy_motion_is_ok_and_a_lie_about_it_is_its_fault, motion_gates),
    Mutation(laws.test_masks_are_consistent, all_measured_is_learned),
    Mutation(laws.test_masks_are_consistent, held_is_measured),
    Mutation(laws.test_stream_equals_replay, live_drops_fresh),
    Mutation(laws.test_stream_equals_replay, live_is_late),
    Mutation(laws.test_two_lies_leave_the_same_filter_limits_and_weights, accused_is_measured),
    Mutation(laws.test_two_lies_leave_the_same_filter_limits_and_weights, limit_learns_all),
    Mutation(laws.test_two_lies_leave_the_same_filter_limits_and_weights, weights_learn_all),
    Mutation(laws.test_a_fault_of_the_motion_changes_neither_filter_nor_limits, motion_gates),
    Mutation(laws.test_what_may_not_learn_does_not, limit_learns_all),
    Mutation(laws.test_what_may_not_learn_does_not, weights_learn_all),
    Mutation(laws.test_infinite_limits, no_limit_is_infinite),
    Mutation(laws.test_infinite_limits, no_limit_is_minus_infinity),
    Mutation(laws.test_a_missing_channel_is_unknown_and_the_others_are_judged, missing_is_ok, (laws.silenced,)),
    Mutation(laws.test_a_missing_channel_is_unknown_and_the_others_are_judged, missing_is_ok, (laws.absent,)),
    Mutation(laws.test_a_missing_channel_is_unknown_and_the_others_are_judged, one_silences_all, (laws.silenced,)),
    Mutation(laws.test_an_empty_sample_is_unknown, missing_is_ok),
    Mutation(laws.test_a_hole_in_the_block_costs_one_sample, nan_stays),
    Mutation(laws.test_permuted_channels_permute_the_verdicts, order_counts),
    Mutation(laws.test_a_fleet_is_its_vehicles, fleet_mixes_vehicles),
    Mutation(laws.test_a_fleet_of_one_is_one, fleet_forgets),
    Mutation(laws.test_saved_and_loaded_it_says_the_same, saving_loses_digits, (None,)),
    Mutation(laws.test_saved_and_loaded_it_says_the_same, saving_loses_a_setting, (None,)),
    Mutation(laws.test_what_load_would_not_know_is_not_saved, saving_takes_anything),
    Mutation(laws.test_one_compilation_a_shape, each_number_compiles),
    Mutation(laws.test_back_after_a_dropout, window_stays_broken),
    Mutation(laws.test_back_after_a_gap_in_the_clock, offended_by_a_gap),
    Mutation(laws.test_back_after_a_long_fault, sum_without_a_ceiling),
    Mutation(laws.test_back_after_a_long_fault, blind_after_a_fault),
    Mutation(laws.test_back_after_a_long_fault, never_readmitted),
    Mutation(laws.test_false_alarms_come_at_the_designed_rate, alarms_too_often),
    Mutation(laws.test_false_alarms_come_at_the_designed_rate, alarms_too_seldom),
)


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda one: f"{one.law.__name__}-{one}")
def test_the_law_catches_it(mutation: Mutation, monkeypatch: Patch) -> None:
    known = registry.parts() | registry.parts_in(["laws.guests"])
    monkeypatch.setattr(registry, "parts", lambda: known)
    with pytest.raises((AssertionError, pytest.fail.Exception)):
        mutation.law(mutation.made(monkeypatch), *mutation.more)


def test_a_sum_with_a_ceiling_is_within_the_law() -> None:
    laws.test_back_after_a_long_fault(summed(16.0))


def test_every_law_has_a_mutation() -> None:
    every = {name for name in vars(laws) if name.startswith("test_")} - {"test_compilations_are_counted"}
    assert every == {one.law.__name__ for one in MUTATIONS}
