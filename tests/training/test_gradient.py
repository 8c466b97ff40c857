"""Training by gradient: what is learned from, when it stops, and that a break makes no difference."""

from dataclasses import replace
from pathlib import Path

import jax
import numpy as np
import pytest
from safetensors.numpy import save_file

from sensorfault.logs.table import LogError
from sensorfault.training.gradient import Plan, Trained, split, train
from sensorfault.training.initial import new_lstm, new_mlp
from sensorfault.training.session import Session
from sensorfault.training.windows import Windows

PLAN = Plan(epochs=12, batch=32, rate=0.01, patience=5)


def windows(rows: int = 400, length: int = 4, seed: int = 0) -> Windows:
    """What comes next is a mean of what was."""
    x = np.random.default_rng(seed).uniform(-1, 1, (rows, 3))
    first = np.arange(rows - length)
    mean = np.array([x[k : k + length, :2].mean(axis=0) for k in first])
    return Windows(x, first, mean, length)


def fitted(plan: Plan = PLAN, seed: int = 0, session: Session | None = None, data: Windows | None = None) -> Trained:
    return train(new_lstm(seed, 3, 2, (4,)), data or windows(), plan, seed, session or Session())


def numbers(done: Trained) -> list[bytes]:
    return [np.asarray(leaf).tobytes() for leaf in jax.tree.leaves(done.net)]


def test_it_learns() -> None:
    done = train(new_mlp(0, 12, 2, (8,)), windows(2000), replace(PLAN, epochs=60), 0)
    assert min(done.validated) < 0.01 * np.var(windows(2000).target)
    assert done.validated[done.best_epoch - 1] == min(done.validated)


def test_the_best_weights_are_kept() -> None:
    """The error of the network that comes back, by NumPy, is the lowest of all epochs and not the last."""
    data = windows(160)
    done = train(new_mlp(0, 12, 2, (64, 64)), data, replace(PLAN, epochs=200, rate=0.1, patience=20), 0)
    assert done.best_epoch < len(done.validated)
    _, judged = split(data, PLAN.validation)
    x = judged.matrix()
    for layer in done.net.hidden:
        x = np.tanh(x @ np.asarray(layer.weights).T + np.asarray(layer.bias))
    result = x @ np.asarray(done.net.output.weights).T + np.asarray(done.net.output.bias)
    assert ((result - judged.target) ** 2).mean() == pytest.approx(min(done.validated), rel=1e-4)


def test_it_stops_when_patience_is_used_up() -> None:
    done = train(new_mlp(0, 12, 2, (64, 64)), windows(160), replace(PLAN, epochs=500, rate=0.1, patience=7), 0)
    assert len(done.validated) == done.best_epoch + 7 < 500
    assert len(fitted().validated) == 12


def test_what_is_judged_is_later_by_a_window_than_what_is_learned() -> None:
    data = windows()
    shuffled = np.random.default_rng(0).permutation(len(data.first))
    for some in (data, data._replace(first=data.first[shuffled], target=data.target[shuffled])):
        learn, judge = split(some, 0.25)
        assert len(judge.first) == 99
        assert judge.first.min() == 297
        # rows first .. first + length - 1, the row asked for, and then a whole window that neither side sees
        assert learn.first.max() + data.length + data.length < judge.first.min()
        assert len(learn.first) == 297 - 2 * data.length
        for part in (learn, judge):
            np.testing.assert_array_equal(part.target, data.target[part.first])


def test_what_is_judged_is_not_learned_from() -> None:
    """The rows of the block that training stops by may hold anything: the first epoch's weights are the same."""
    data = windows()
    other = data.rows.copy()
    other[-60:] = 0.9
    target = data.target.copy()
    target[-60:] = 5.0
    plan = replace(PLAN, epochs=1)
    assert numbers(fitted(plan)) == numbers(fitted(plan, data=data._replace(rows=other, target=target)))


def test_the_same_seed_the_same_network() -> None:
    assert numbers(fitted()) == numbers(fitted())
    assert numbers(fitted()) != numbers(fitted(seed=1))


def test_every_epoch_is_told() -> None:
    result: list[str] = []
    done = fitted(session=Session(result.append))
    assert len(result) == len(done.validated)
    assert result[2] == f"epoch 3 of at most 12, validation error {np.sqrt(done.validated[2]):.3g}"


@pytest.mark.parametrize("after", [1, 4, 11])
def test_a_break_makes_no_difference(after: int, tmp_path: Path) -> None:
    """Stopped after any epoch and gone on from the checkpoint: the same to the bit."""
    path = tmp_path / "half.checkpoint"
    result: list[str] = []

    def break_off(said: str) -> None:
        if len(result) == after:
            raise KeyboardInterrupt
        result.append(said)

    with pytest.raises(KeyboardInterrupt):
        fitted(session=Session(break_off, path))
    later: list[str] = []
    done = fitted(session=Session(later.append, path))
    assert later[0].startswith(f"epoch {after + 1} ")
    assert numbers(done) == numbers(fitted())
    assert done.validated == fitted().validated
    assert done.learned == fitted().learned
    again: list[str] = []
    assert numbers(fitted(session=Session(again.append, path))) == numbers(done)
    assert not again


def sentence(path: Path, **how: object) -> str:
    with pytest.raises(LogError) as raised:
        fitted(session=Session(checkpoint=path), **how)  # type: ignore[arg-type]
    text = str(raised.value)
    assert text.startswith(f"{path}: ")
    assert text.endswith(".")
    assert "\n" not in text
    return text


def test_a_foreign_checkpoint_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "half.checkpoint"
    fitted(session=Session(checkpoint=path))
    before = path.read_bytes()
    for how in ({"seed": 1}, {"data": windows(seed=1)}, {"plan": replace(PLAN, rate=0.02)}):
        assert "another log, method or seed" in sentence(path, **how)
    with pytest.raises(LogError, match="another log, method or seed"):
        train(new_mlp(0, 12, 2, (8,)), windows(), PLAN, 0, Session(checkpoint=path))
    assert path.read_bytes() == before
    for length in (0, 5, 100, len(before) - 1):
        path.write_bytes(before[:length])
        assert "not a checkpoint, or cut short" in sentence(path)
    save_file({"weight": np.zeros(3)}, path)
    assert "not a checkpoint of this version" in sentence(path)
    path.unlink()
    path.mkdir()
    assert "not a checkpoint" in sentence(path)


@pytest.mark.parametrize("rows", [4, 5, 30, 60])
def test_too_few_windows(rows: int) -> None:
    with pytest.raises(LogError, match="are too few: ") as raised:
        fitted(data=windows(rows))
    assert str(raised.value).endswith("give a longer log.")
