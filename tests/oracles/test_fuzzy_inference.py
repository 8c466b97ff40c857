"""The statistics that learn from labelled innovations, in a monitor: each channel by its own model, and stored."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from core.scripted import FromBlock, Said
from laws.walk import walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Residual, Sample
from sensorfault.core.verdicts import FAULT, OK
from sensorfault.runtime.encoding import decode, encode
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.fuzzy_inference import FuzzyInference
from sensorfault.stages.statistic.logistic_regression import LogisticRegression
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.fuzzy import Setting, fit_anfis
from sensorfault.training.logistic import fit_logistic

CHANNELS, COLUMNS = 3, (0, 2)
ANY = jnp.full(2, jnp.inf)  # variance of an innovation


def learned(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Innovations of FromBlock's unit variances, in which a large one means a large error."""
    r = np.abs(np.random.default_rng(seed).normal(0, 3, 120))
    return np.column_stack([r, r**2, np.ones(120)]), r


def statistic(name: str) -> FuzzyInference | LogisticRegression:
    if name == "fuzzy":
        settings = (Setting(epochs=5), Setting(partition="scatter", rules=3, log=True, epochs=5))
        models = (fit_anfis(*learned(s), setting).model for s, setting in enumerate(settings))
        return FuzzyInference(tuple(models), ANY, COLUMNS)
    return LogisticRegression(
        tuple(fit_logistic(learned(s)[0], learned(s)[1] > 2) for s in range(2)), jnp.full(2, jnp.inf), COLUMNS
    )


def rows() -> Sample:
    rng = np.random.default_rng(9)
    value = 5.0 + 3 * rng.standard_normal((40, CHANNELS))
    value[rng.random(value.shape) < 0.2] = np.nan
    return samples(np.arange(40.0), value, ~np.isnan(value), Said((np.zeros((40, 1)),), np.full((40, CHANNELS), 5.0)))


def monitor(part: eqx.Module, limit: float) -> Monitor:
    branch = Branch(part, Fixed(jnp.full(CHANNELS, limit)))
    return Monitor(FromBlock(CHANNELS), (branch,), Exceed(), Drop(), jnp.full(CHANNELS, 0.5), (0, 1, 2))


@pytest.mark.parametrize(("name", "limit"), [("fuzzy", 4.0), ("logistic", 0.0)])
def test_each_channel_is_judged_by_its_own_model(name: str, limit: float) -> None:
    part = statistic(name)
    result = walk(monitor(part, limit), rows())
    score, fresh, r = result.reports.scores[0], np.asarray(rows().fresh), np.asarray(rows().value) - 5.0
    np.testing.assert_array_equal(score.valid, fresh & [True, False, True])
    assert np.isfinite(score.value).all()
    for model, column in zip(part.models, COLUMNS, strict=True):
        there = fresh[:, column]
        e = r[there, column]
        want = jax.tree.map(np.asarray, model)(np.column_stack([np.abs(e), e**2, np.ones(len(e))]))
        np.testing.assert_allclose(score.value[there, column], want, rtol=1e-9, atol=1e-12)
        np.testing.assert_array_equal(result.channel[there, column], np.where(want > limit, FAULT, OK))
        assert 0 < (want > limit).sum() < len(e)


def test_what_is_not_valid_is_no_number_to_fear() -> None:
    value, one = jnp.asarray([jnp.nan, 1.0, jnp.inf]), jnp.ones(CHANNELS)
    residual = Residual(jnp.zeros(()), value, jnp.eye(CHANNELS), value, value, one, jnp.isfinite(value), one > 1)
    score, _ = statistic("logistic").evaluate((), residual)
    assert np.isfinite(score.value).all()
    assert not score.valid.any()


@pytest.mark.parametrize("name", ["fuzzy", "logistic"])
def test_it_is_stored_to_the_bit(name: str) -> None:
    part = statistic(name)
    tensors: dict[str, np.ndarray] = {}
    again = decode(encode(part, "statistic", tensors), tensors)
    assert eqx.tree_equal(part, again)
    assert again.columns == COLUMNS
