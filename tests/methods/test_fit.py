"""Healthy data in, model out: what is learned from what, and what is said of it."""

from dataclasses import replace
from functools import cache

import jax
import numpy as np
import pytest

import fitted
from sensorfault.logs.table import Channel, Log, LogError, Sensor
from sensorfault.methods.catalog import DEFAULT, METHODS
from sensorfault.methods.common.watch import watchable
from sensorfault.methods.fit import fit
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model

WITHOUT_CHANCE = "pca", "linear-conditioning", "relative-conditioning"
ON_THE_RIG = ("elm-autoencoder", "elm-cross-validated", "elm-robust", *WITHOUT_CHANCE)
OF_THE_POSITION = (
    "lstm-predictor",
    "lstm-displacement",
    "mlp-predictor",
    "ar-predictor",
    "persistence",
    "linear-extrapolation",
)


def log() -> Log:
    return fitted.rig().between(end_s=40.0)


def numbers(model: Model) -> list[bytes]:
    return [np.asarray(leaf).tobytes() for leaf in jax.tree.leaves(model.monitor)]


@cache
def default() -> Model:
    return fit(log())


def test_the_catalog() -> None:
    of_motion = {"motion-deficit", "bicycle-kalman", "side-force", "car-composite"}
    slow = {"cusum", "ramp-glr", "slope", "mean-pair"}
    of_height = {"multistep-observer", "kinematic-observer", "height-agreement", "drone-composite", *slow}
    gates = {f"chi-square-{filter}-{far}" for filter in ("ckf", "ackf") for far in ("05", "01")}
    learned = {"double-threshold", "anfis-cubature", "anfis-cubature-9m", "logistic-cubature"}
    of_ranges = {"cooperative", *gates, *learned}
    of_satellites = {"satellite-bank", "lof-efd", "innovation-chi-square", "averaged-innovation"}
    others = {"bp-autoencoder", "online-network", "arm-kalman", *of_motion, *of_height, *of_ranges, *of_satellites}
    assert set(METHODS) == {*ON_THE_RIG, *OF_THE_POSITION, *others}
    assert DEFAULT == "relative-conditioning"
    for name, recipe in METHODS.items():
        assert recipe.name == name
        assert recipe.title
        assert recipe.source
        assert recipe.false_alarm_rate


def test_limits_are_frozen_on_other_data_than_they_are_judged_on() -> None:
    """Whatever stands in the part held out, the model is the same; what is said of it is not."""
    cut = 40.0 * 0.7
    value = log().value.copy()
    value[log().time > cut, 2] += 50.0
    changed = fit(replace(log(), value=value))
    assert numbers(changed) == numbers(default())
    assert default().summary["held_out_alarms"] == 0
    assert changed.summary["held_out_alarms"] >= 1
    assert changed.summary["alarms_per_hour"] > default().summary["alarms_per_hour"] == 0


def test_what_is_not_held_out_is_learned() -> None:
    value = log().value.copy()
    value[100, 2] += 50.0
    assert numbers(fit(replace(log(), value=value))) != numbers(default())


def test_the_model_of_the_first_part_is_that_of_a_log_which_ends_there() -> None:
    """Nothing of the part held out is peeped at: neither its length nor its clock."""
    alone = fit(log().between(end_s=28.0), held_out=0.0)
    assert numbers(alone) == numbers(fit(log(), held_out=(39.98 - 28.0) / 39.98))


@pytest.mark.parametrize("share", [0.1, 0.3, 0.6])
def test_the_summary_tells_how_it_was_fitted(share: float) -> None:
    model = fit(log(), held_out=share, seed=3)
    result = model.summary
    assert result["held_out_s"] == pytest.approx(share * 39.98, abs=0.05)
    assert result["training_s"] == pytest.approx((1 - share) * 39.98, abs=0.05)
    assert result["rows"] == pytest.approx(2000 * (1 - share), abs=2)
    assert result["alarms_per_hour"] == result["held_out_alarms"] / (result["held_out_s"] / 3600)
    assert (result["training_log"], result["seed"]) == ("rig 0", 3)
    assert set(result["not_watched"]) == {"gnss.east", "gnss.north"}
    assert model.watched == (True,) * 6 + (False,) * 2


def test_with_nothing_held_out_nothing_is_known_of_the_rate() -> None:
    model = fit(log(), held_out=0.0)
    assert model.summary["training_s"] == pytest.approx(39.98)
    assert not {"held_out_s", "held_out_alarms", "alarms_per_hour"} & set(model.summary)


@pytest.mark.parametrize("method", ON_THE_RIG)
def test_the_same_seed_gives_the_same_model(method: str) -> None:
    one, again, other = (fit(log(), method, seed=seed) for seed in (1, 1, 2))
    assert numbers(one) == numbers(again)
    assert (numbers(one) == numbers(other)) is (method in WITHOUT_CHANCE)
    assert one.method == method


@pytest.mark.parametrize("method", ON_THE_RIG)
def test_every_method_finds_a_plain_fault_and_keeps_quiet_without(method: str) -> None:
    model = fitted.model(method)
    assert detect(model, fitted.unseen()).events == ()
    value = fitted.unseen().value.copy()
    value[1000, 3] += 30.0
    events = detect(model, replace(fitted.unseen(), value=value)).events
    assert [(e.sensor, e.channel, e.kind, e.method) for e in events] == [("accelerometer", "x", "spike", method)]
    assert events[0].start_s == events[0].end_s == fitted.unseen().time[1000]


def test_progress_is_told_in_words() -> None:
    result: list[str] = []
    fit(log(), progress=result.append)
    assert len(result) == 3
    assert DEFAULT in result[0]
    assert "held-out" in result[-1]


def sentence(log: Log, **how: object) -> str:
    with pytest.raises(LogError) as raised:
        fit(log, **how)  # type: ignore[arg-type]
    text = str(raised.value)
    assert "\n" not in text
    assert text.endswith(".")
    return text


@pytest.mark.parametrize("rows", [0, 1])
def test_no_log_to_speak_of(rows: int) -> None:
    short = log().between(end_s=0.02 * rows - 0.01)
    assert len(short) == rows
    assert f"has {rows} rows" in sentence(short)


def test_too_few_rows() -> None:
    assert "needs 50" in sentence(log().between(end_s=0.9), held_out=0.0)
    assert "46 rows that follow 4 complete ones" in sentence(log().between(end_s=1.0), held_out=0.0)
    fit(log().between(end_s=1.0), "elm-autoencoder", held_out=0.0)


def test_an_unknown_method() -> None:
    assert "did you mean lstm" in sentence(log(), method="lstm")


@pytest.mark.parametrize("share", [-0.1, 0.95, 1.0, 5.0, float("nan")])
def test_an_impossible_share(share: float) -> None:
    assert "0 to 0.9" in sentence(log(), held_out=share)


def test_nothing_to_watch() -> None:
    constant = replace(log(), value=np.ones_like(log().value))
    said = sentence(constant)
    assert "no channel to watch" in said
    assert "gyro.x: constant" in said
    absent = fitted.shifted(log(), np.full_like(log().value, np.nan))
    assert "no channel to watch" in sentence(absent)
    fixes = log().select(["gnss.east", "gnss.north"])
    assert "slower than the clock" in sentence(fixes)


def test_channels_that_never_come_together() -> None:
    """Every channel is there half the time, but no row has them all."""
    value = log().value.copy()
    value[::2, :3] = np.nan
    value[1::2, 3:6] = np.nan
    said = sentence(fitted.shifted(log(), value), method="elm-autoencoder")
    assert "has 0 rows with every watched channel" in said


def test_watchable_says_why_not() -> None:
    value = log().value.copy()
    value[:, 1] = 0.5
    value[:1500, 4] = np.nan
    watched, reasons = watchable(fitted.shifted(log(), value))
    assert watched.tolist() == [True, False, True, True, False, True, False, False]
    assert set(reasons) == {"gyro.y", "accelerometer.y", "gnss.east", "gnss.north"}
    assert "constant" in reasons["gyro.y"]
    assert reasons["accelerometer.y"] == "a value in only 25% of the rows"
    assert reasons["gnss.east"] == "slower than the clock"


def test_sensors_that_are_all_silent_at_times_are_watched_all_the_same() -> None:
    value = log().value.copy()
    value[600:1300, :6] = np.nan
    silent = fitted.shifted(log(), value)
    watched, _ = watchable(silent, often=0.9)
    assert watched.tolist() == [True] * 6 + [False] * 2
    made = fit(silent, "relative-conditioning", held_out=0.0)
    assert made.summary["rows"] == 1300


def test_a_channel_that_moves_in_one_stretch_only_is_not_watched() -> None:
    value = log().value.copy()
    value[300:, 3] = 7.0
    made = fit(fitted.shifted(log(), value), "relative-conditioning", held_out=0.0)
    assert made.watched == (True, True, True, False, True, True, False, False)
    assert made.summary["not_watched"]["accelerometer.x"] == "changes in one stretch of the training data only"


def test_a_constant_channel_is_watched_for_silence() -> None:
    """It carries no weight and no verdict, yet its sensor's silence is an event."""
    value = log().value.copy()
    value[:, 3:6] = 1.0
    still = replace(log(), value=value)
    model = fit(still, held_out=0.0)
    assert model.watched == (True,) * 3 + (False,) * 5
    moved = value.copy()
    moved[500, 3:6] = 99.0
    moved[1000:1200, 3:6] = np.nan
    events = detect(model, fitted.shifted(still, moved)).events
    assert [(e.sensor, e.channel, e.kind) for e in events] == [("accelerometer", None, "missing")]


def test_gaps_in_the_training_are_no_rows_of_it() -> None:
    value = log().value.copy()
    value[200:300, 0] = np.nan
    model = fit(fitted.shifted(log(), value), held_out=0.0)
    assert model.summary["rows"] == 1900
    assert all(np.isfinite(np.asarray(leaf)).all() for leaf in jax.tree.leaves(model.monitor.residual))


def test_conditioning_wants_rows_in_a_row() -> None:
    """A channel that comes with four of five ticks is left to its silence; where all are like that, it is said."""
    late = log().value.copy()
    late[::5, 0] = np.nan
    made = fit(fitted.shifted(log(), late), "relative-conditioning", held_out=0.0)
    assert made.summary["not_watched"]["gyro.x"] == "a value in only 80% of the rows"
    assert made.watched[1]
    late[::3, :6] = np.nan
    assert "no channel to watch" in sentence(fitted.shifted(log(), late), method="relative-conditioning")


def test_a_method_takes_measurements_and_what_may_be_judged() -> None:
    whole = log()
    said = (
        Channel("fix_type", "gnss", watch=False, kind="quality"),
        Channel("mode", "mode", watch=False, kind="context"),
        Channel("x", "estimated_local_position", "m", watch=False, kind="estimate"),
    )
    more = np.tile(np.arange(len(whole), dtype=float)[:, None], (1, len(said)))
    sensors = (*whole.sensors, Sensor("mode", 1.0), Sensor("estimated_local_position", 0.1))
    wide = replace(
        whole,
        value=np.concatenate([whole.value, more], axis=1),
        fresh=np.concatenate([whole.fresh, np.ones(more.shape, bool)], axis=1),
        channels=(*whole.channels, *said),
        sensors=sensors,
    )
    model = fit(wide, "pca")
    assert model.channels == whole.channels
    assert numbers(model) == numbers(fit(whole, "pca"))
    assert not detect(model, wide).events
