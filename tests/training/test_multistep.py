"""How the observer's network is trained: what it minimises, when it ends, and on which windows."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import flown
from sensorfault.logs.table import LogError
from sensorfault.training.fixes import Fixes
from sensorfault.training.multistep import Schedule, Trained, train_steps
from sensorfault.training.roll_out import errors

COLUMNS = (flown.DOWN, flown.PITCH, flown.THROTTLE)
STEPS = (1, 4)


@cache
def fixes() -> Fixes:
    return Fixes.of(flown.flight(), flown.HEIGHT, COLUMNS)


@cache
def trained() -> Trained:
    return train_steps(fixes(), STEPS, (0, 1), Schedule(epochs=60, rate=3e-3))


def test_the_loss_weighs_early_steps_more() -> None:
    """Before it has learned the network foretells no change: the loss of a first epoch that moves nothing is known."""
    own = fixes()
    start = own.windows(4)
    untaught = train_steps(own, STEPS, schedule=Schedule(epochs=1, rate=0.0, batch=len(start)))
    _, _, unit = own.scale()
    away = np.stack([(own.height[start + j] - own.height[start]) / unit for j in (1, 2, 3, 4)])
    square = (away**2).mean(axis=1)
    assert untaught.loss[0, 0, 0] == pytest.approx(square[0], rel=1e-4)
    assert untaught.loss[0, 1, 0] == pytest.approx(square @ [4, 3, 2, 1] / 10, rel=1e-4)


def test_it_learns() -> None:
    result = trained()
    assert (np.nanmin(result.loss, axis=2) < 0.2 * result.loss[:, :, 0]).all()
    persistence = np.sqrt(np.mean((fixes().height[4:] - fixes().height[:-4]) ** 2))
    for nets in result.nets:
        assert np.sqrt(np.mean(errors(nets[1], fixes(), (4,)) ** 2)) < 0.3 * persistence


def test_seeds_and_numbers_of_steps_do_not_meet() -> None:
    """Trained together they become what each becomes alone."""
    alone = train_steps(fixes(), (4,), (1,), Schedule(epochs=60, rate=3e-3))
    np.testing.assert_allclose(alone.loss[0, 0], trained().loss[1, 1], rtol=1e-3)
    assert np.nanmax(np.abs(trained().loss[0] - trained().loss[1])) > 1e-3


def test_it_ends_when_no_epoch_is_better() -> None:
    result = train_steps(fixes(), (1, 2), schedule=Schedule(epochs=200, rate=0.03, every=20, patience=5))
    for loss in result.loss[0]:
        done = int(np.isfinite(loss).sum())
        assert done < 200
        assert np.isnan(loss[done:]).all()
        assert loss[done - 5 : done].min() >= loss[: done - 5].min()
        for k in range(6, done):
            assert loss[k - 5 : k].min() < loss[: k - 5].min()


def test_what_has_ended_stands_still() -> None:
    """While others go on."""
    plan = Schedule(epochs=200, rate=0.03, every=20, patience=5)
    together = train_steps(fixes(), (1, 2), schedule=plan)
    done = np.isfinite(together.loss[0]).sum(axis=1)
    assert done[0] != done[1]
    early = int(np.argmin(done))
    stopped = train_steps(fixes(), (1, 2), schedule=replace(plan, epochs=int(done[early])))
    one, two = together.nets[0][early], stopped.nets[0][early]
    np.testing.assert_array_equal(one.weights, two.weights)
    np.testing.assert_array_equal(one.offset, two.offset)


def test_rates_drop_by_steps() -> None:
    """With a rate that drops to nothing, nothing moves any more."""
    result = train_steps(fixes(), (1,), schedule=Schedule(epochs=12, rate=1e-3, drop=0.0, every=4, batch=10_000))
    loss = result.loss[0, 0]
    assert (np.diff(loss[:5]) < 0).all()
    np.testing.assert_allclose(loss[5:], loss[4], rtol=1e-6)


def test_each_step_may_have_weights_of_its_own() -> None:
    result = train_steps(fixes(), (2, 3), schedule=Schedule(epochs=5, separate=True))
    two, three = result.nets[0]
    assert np.asarray(two.weights).shape[0] == 3
    assert (np.asarray(two.output)[2] == 0).all()  # the third step of two
    assert (np.asarray(three.output) != 0).all()


def test_windows_go_over_no_gap_and_no_unknown_input() -> None:
    log = flown.flight(20.0)
    value = log.value.copy()
    value[40, flown.PITCH] = np.nan
    holed = replace(log, time=log.time + np.where(np.arange(100) < 70, 0.0, 3.0), value=value, fresh=np.isfinite(value))
    own = Fixes.of(holed, flown.HEIGHT, COLUMNS)
    assert own.period_s == pytest.approx(0.2)
    np.testing.assert_array_equal(own.windows(5), [*range(35), *range(41, 65), *range(70, 95)])


def test_inputs_stand_between_their_measurements() -> None:
    """On a clock of 25 Hz the heights are new at each fifth row; a speed that comes with them stands till the next."""
    log = flown.flight(20.0, hz=25.0)
    own = Fixes.of(log, flown.HEIGHT, COLUMNS)
    assert len(own.time) == 100
    np.testing.assert_array_equal(own.inputs, log.value[::5][:, COLUMNS])
    late = replace(log, fresh=np.roll(log.fresh, 2, axis=0))
    moved = np.roll(log.value, 2, axis=0)
    moved[:, flown.HEIGHT], late.fresh[:, flown.HEIGHT] = log.value[:, flown.HEIGHT], log.fresh[:, flown.HEIGHT]
    shifted = Fixes.of(replace(late, value=moved), flown.HEIGHT, (flown.DOWN,))
    np.testing.assert_array_equal(shifted.inputs[1:, 0], log.value[:-5:5, flown.DOWN])


def test_too_little_to_learn_from() -> None:
    short = flown.flight(20.0)
    with pytest.raises(LogError, match="needs 40; give it more data"):
        train_steps(Fixes.of(short, flown.HEIGHT, COLUMNS), (70,))
    with pytest.raises(LogError, match=r"has 30 measurements of gnss\.altitude"):
        Fixes.of(short.between(end_s=6.0), flown.HEIGHT, COLUMNS)
