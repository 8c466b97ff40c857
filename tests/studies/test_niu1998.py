"""Paper B: what is counted and how, on hand-made verdicts and small fleets; then what the issue asks for."""

import io
import tarfile
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.faults.fault import KINDS
from sensorfault.logs.table import LogError
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.simulation.arm import AS_PRINTED, PHYSICAL, run
from sensorfault.training.session import SILENT
from sensorfault_studies.findings import Effort
from sensorfault_studies.niu1998 import drifts as study
from sensorfault_studies.niu1998.drifts import drifts, smallest
from sensorfault_studies.niu1998.figures import of_slow_drifts, of_the_run
from sensorfault_studies.niu1998.fleet import BATCH, Result, watch, with_limits
from sensorfault_studies.niu1998.isolation import (
    LASTING,
    ONSET,
    SENSORS,
    WINDOW,
    Calibrated,
    Runs,
    isolated,
    missed,
    stretches,
    trials,
)
from sensorfault_studies.niu1998.joints import APART
from sensorfault_studies.niu1998.rivals import KALMAN, NETWORK, SCRATCH, Rival, of_six_joints, of_two_links
from sensorfault_studies.niu1998.run import Watched, early, first, found_soon, increment_error, joined, theta
from sensorfault_studies.niu1998.schunk import runs
from sensorfault_studies.numbers import Numbers


@cache
def persistence() -> Model:
    return METHODS["persistence"].build(joined([run(seed=s) for s in (90, 91)]), 0, SILENT)


def of(verdicts: np.ndarray) -> Result:
    nothing = np.zeros(verdicts.shape)
    return Result(verdicts.astype(np.int8), nothing, nothing[0, 0], nothing, nothing)


def test_a_fleet_says_what_a_replay_says() -> None:
    logs = [run(seed=seed) for seed in range(BATCH + 2)]
    limit = np.array([0.01, 0.01, 0.02, 0.02, np.inf, np.inf])
    model = with_limits(persistence(), limit)
    result = watch(model, logs)
    assert result.channel.shape == (BATCH + 2, 100, 6)
    np.testing.assert_array_equal(result.limit, limit)
    for i in (0, BATCH + 1):
        one = replay_log(model.monitor, logs[i])
        np.testing.assert_array_equal(result.channel[i], one.channel)
        np.testing.assert_allclose(result.residual[i], one.residual, atol=1e-12)
    assert result.fault[:, :, :4].any()
    assert not result.fault[:, :, 4:].any()
    assert not result.tested[:, 0].any()


def test_thresholds_are_the_papers_rule() -> None:
    for setting in (AS_PRINTED, PHYSICAL):
        limit = theta(setting)
        assert limit[1] == pytest.approx(0.024, abs=7e-4)
        assert limit[3] == pytest.approx(0.0182, abs=1e-4)
        assert np.isinf(limit[4:]).all()


def test_joined_runs_have_pauses_between_them() -> None:
    both = joined([run(seed=1), run(seed=2)])
    steps = np.diff(both.time)
    assert len(both) == 200
    assert steps[99] == pytest.approx(1.0)
    np.testing.assert_allclose(np.delete(steps, 99), 0.001)
    np.testing.assert_array_equal(both.value[100:], run(seed=2).value)


def test_when_drifts_are_found() -> None:
    verdicts = np.full((4, 100, 6), OK)
    verdicts[0, 51:, 1] = verdicts[0, 52:, 3] = FAULT
    verdicts[1, 51:, 1] = verdicts[1, 53:, 3] = FAULT
    verdicts[2, 50:, 1] = verdicts[2, 51:, 3] = FAULT
    verdicts[3, 49, 0] = FAULT
    result = of(verdicts)
    assert first(result, 1).tolist() == [51, 51, 50, 100]
    assert first(result, 3).tolist() == [52, 53, 51, 100]
    assert found_soon(result).tolist() == [True, False, False, False]
    assert early(result).tolist() == [False, False, False, True]


def test_the_smallest_drift_has_no_hole_above_it() -> None:
    numbers = Numbers("B", "arm", "simulated")
    for rate, share in ((2.0, 1.0), (1.0, 0.96), (0.5, 0.9), (0.1, 1.0)):
        numbers.add("y2", "good", {"detection_rate": share}, "drift", rate)
    assert smallest(numbers, "y2", "good", (0.1, 0.5, 1.0, 2.0)) == 1.0
    assert np.isnan(smallest(numbers, "y2", "bad", (1.0, 2.0)))


def test_numbers_become_rows() -> None:
    numbers = Numbers("B", "arm", "simulated")
    for value in (0.5, 1.0):
        numbers.add("as-printed", "good", {"far": value}, "drift")
    (row,) = numbers.rows()
    assert (row.experiment, row.data, row.source, row.condition) == ("B", "arm", "simulated", "as-printed")
    assert (row.value, row.spread, row.seeds) == (0.75, pytest.approx(np.std([0.5, 1.0], ddof=1)), 2)
    assert numbers.mean("as-printed", "good", "far", "drift") == 0.75


def test_what_is_told_of_the_papers_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """With persistence in the network's place."""

    def build(log, seed):
        return METHODS["persistence"].build(log, seed, SILENT)

    rivals = (Rival(NETWORK, "", build), Rival(NETWORK, SCRATCH, build))
    monkeypatch.setattr(study, "of_two_links", lambda arm, limits: rivals)
    shares: list[float] = []
    result = drifts(Effort(seeds=1, quick=True, progress=lambda doing, share: shares.append(share)))
    rows = list(result.rows())
    assert len({(r.condition, r.method, r.fault, r.magnitude, r.metric) for r in rows}) == len(rows)
    assert shares == sorted(shares)
    found = {(r.condition, r.metric, r.magnitude): r for r in rows}
    assert found["as-printed", "theta_y2", None].paper == 0.024
    assert found["as-printed", "sample_y4", None].paper == 51
    assert found["physical", "sample_y4", None].paper is None
    assert found["as-printed", "theta_y4", None].value == pytest.approx(0.0182, abs=1e-4)
    assert found["as-printed far5e-2", "far", None].value <= 0.2
    assert found["as-printed far5e-2 y2", "detection_rate", 2.0].value > 0.9
    assert found["as-printed far5e-2 y2", "detection_rate", 0.1].value < 0.2
    assert found["as-printed noise-free", "rms", None].value < found["as-printed", "rms", None].value
    figures = (*of_the_run(result), *of_slow_drifts(rows))
    assert [figure.name for figure in figures] == [
        "b_prediction_y2", "b_residual_y2", "b_prediction_y4", "b_residual_y4", "b_slow_y2", "b_slow_y4",
    ]  # fmt: skip


def archive(path: Path, runs_of: dict[str, dict[str, np.ndarray]]) -> Path:
    with tarfile.open(path, "w:gz") as tar:
        for run_name, tables in runs_of.items():
            for name, table in tables.items():
                text = io.BytesIO()
                np.savetxt(text, table, delimiter=",")
                info = tarfile.TarInfo(f"Robot/{run_name}/{name}.csv")
                info.size = text.tell()
                text.seek(0)
                tar.addfile(info, text)
    return path


def a_run(rows: int, seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    swing = np.cumsum(rng.uniform(-1, 1, (rows, 12)), axis=0)
    return {"time": 0.004 * np.arange(rows), "trajectory": swing, "input": rng.uniform(-1, 1, (rows - 1, 6))}


def test_runs_of_an_archive(tmp_path: Path) -> None:
    """Angles come first in the file, rates in the log; the last torque is missing."""
    tables = {f"measurement_{i}": a_run(20 + i, i) for i in (10, 2)}
    logs = runs(archive(tmp_path / "arm.tar.gz", tables))
    assert [log.name for log in logs] == ["measurement 2", "measurement 10"]
    log, table = logs[1], tables["measurement_10"]
    assert [log.channels[i].path for i in (0, 6, 12)] == ["tachometer1.rate", "encoder1.angle", "drive1.torque"]
    np.testing.assert_allclose(log.value[:, :6], table["trajectory"][:, 6:])
    np.testing.assert_allclose(log.value[:, 6:12], table["trajectory"][:, :6])
    np.testing.assert_allclose(log.value[:-1, 12:], table["input"])
    assert not log.fresh[-1, 12:].any()
    assert log.period_s == pytest.approx(0.004)


def test_bad_archives_are_refused_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read"):
        runs(tmp_path / "none.tar.gz")
    with pytest.raises(LogError, match="no runs in it"):
        runs(archive(tmp_path / "empty.tar.gz", {}))
    short = a_run(20, 0) | {"input": np.zeros((20, 6))}
    with pytest.raises(LogError, match="with one less"):
        runs(archive(tmp_path / "short.tar.gz", {"measurement_1": short}))


@cache
def swinging() -> tuple:
    """Runs of six joints that swing smoothly."""
    time = 0.004 * np.arange(400)
    from sensorfault_studies.niu1998 import schunk

    logs = []
    for i in range(8):
        phase = np.random.default_rng(i).uniform(0, 6, (1, 6))
        angle, rate = np.sin(2 * time[:, None] + phase), 2 * np.cos(2 * time[:, None] + phase)
        tables = {"time": time[:, None], "trajectory": np.hstack([angle, rate]), "input": angle[:-1]}
        logs.append(schunk._log(f"measurement_{i}", tables))
    return tuple(logs)


def test_runs_are_for_one_thing_only() -> None:
    parts = Runs.of(swinging(), 0)
    names = [{log.name for log in group} for group in (parts.learned, parts.other, parts.judged)]
    assert sum(len(group) for group in names) == len(set.union(*names)) == 8
    assert [len(group) for group in names] == [4, 2, 2]
    parts = Runs.of_another_motion(swinging())
    assert [log.name for log in parts.judged] == ["measurement 6", "measurement 7"]
    assert {log.name for log in (*parts.learned, *parts.other)} == {f"measurement {i}" for i in range(6)}


def test_faults_are_as_large_as_asked() -> None:
    healthy = stretches(swinging()[:3])
    assert {len(log) for log in healthy} == {WINDOW}
    clean = {log.value[:, :SENSORS].tobytes(): log for log in healthy}
    unit = np.where(np.arange(18) < 6, 2e-3, 1e-3)
    found = trials(healthy, unit, 2, 0, quick=False)
    assert {trial.kind for trial in found} == set(KINDS)
    before = np.array([log.value[:ONSET, :SENSORS] for log in clean.values()])
    for trial in found:
        (i,) = np.flatnonzero((before == trial.log.value[:ONSET, :SENSORS]).all(axis=(1, 2)))
        change = trial.log.value[:, :SENSORS] - healthy[i].value[:, :SENSORS]
        changed = np.argwhere(~(change == 0))
        assert set(changed[:, 1]) == {trial.column}
        assert changed[:, 0].min() in (ONSET, ONSET + 1)
        assert changed[:, 0].max() < ONSET + LASTING
        size = trial.size * unit[trial.column]
        if trial.kind in ("spike", "offset"):
            np.testing.assert_allclose(np.abs(change[change != 0]), size)
        if trial.kind == "drift":
            assert abs(change[ONSET + 1, trial.column]) == pytest.approx(size)
        if trial.kind == "frozen":
            assert abs(change[ONSET, trial.column]) >= 5 * unit[trial.column]


def test_who_is_accused_first() -> None:
    verdicts = np.full((5, WINDOW, 18), OK)
    verdicts[0, ONSET + 2 :, 3] = FAULT  # the right one
    verdicts[1, ONSET, [3, 4]] = FAULT  # with another
    verdicts[2, ONSET - 1, 3] = FAULT  # before
    verdicts[3, ONSET + 1, 5] = FAULT  # another alone, then the right one
    verdicts[3, ONSET + 2, 3] = FAULT
    became = isolated(of(verdicts), np.full(5, 3))
    assert became.right.tolist() == [True, False, False, False, False]
    assert became.calm.tolist() == [True, True, False, True, True]
    np.testing.assert_array_equal(became.delay, [2, 0, np.nan, 1, np.nan])
    assert became.named[3].nonzero()[0].tolist() == [5]


def test_a_miss_is_unknown_all_the_while() -> None:
    verdicts = np.full((3, WINDOW, 18), OK)
    verdicts[:2, ONSET : ONSET + LASTING, 3] = UNKNOWN
    verdicts[1, ONSET + 5, 4] = FAULT
    verdicts[2, ONSET : ONSET + LASTING - 1, 3] = UNKNOWN
    assert missed(of(verdicts), np.full(3, 3)).tolist() == [True, False, False]


# What the issue asks for.


@pytest.mark.parametrize("variant", ["", SCRATCH])
def test_both_drifts_are_found_at_once_by_the_network(variant: str) -> None:
    """Must, as printed: 95 % found at 51 or 52, 95 % without an early alarm; one-step error of the rates 0.007 rad/s
    with noise, 0.003 without. Taught beforehand, and with random weights to begin with.
    """
    limit = theta(AS_PRINTED)
    paths = {"tachometer1.rate": 0, "tachometer2.rate": 1, "encoder1.angle": 2, "encoder2.angle": 3}
    rivals = of_two_links(AS_PRINTED.constants, {path: float(limit[c]) for path, c in paths.items()})
    network = next(rival for rival in rivals if (rival.method, rival.variant) == (NETWORK, variant))
    watched = replace(Watched.of(network, AS_PRINTED, 0), seeds=range(200))
    model = with_limits(watched.model, limit)
    result = watch(model, watched.drifting({"tachometer2": 2 * float(limit[1]), "encoder2": 2 * float(limit[3])}))
    assert found_soon(result).mean() >= 0.95
    assert early(result).mean() <= 0.05
    assert increment_error(watch(watched.uncalibrated, watched.healthy())) <= 0.007
    assert increment_error(watch(watched.uncalibrated, watched.healthy(0.0))) <= 0.003


@pytest.mark.real
def test_isolation_on_the_real_arm(real_data: Path) -> None:
    """Must: right in 95 % of shorts, biases and jams of five one-step errors, with one healthy sample in a hundred with
    anybody over his limit. Biases alone are 95 % give or take 3 over the study's seeds.
    """
    parts = Runs.of(runs(real_data / "arm" / "schunk_arm.tar.gz"), 0)
    network, *_ = of_six_joints(APART)
    own = Calibrated.of(network.build(joined(parts.learned), 0), stretches(parts.other))
    faults = trials(stretches(parts.judged), own.unit, 8, 0, quick=True)
    faults = [trial for trial in faults if trial.kind in ("spike", "offset", "frozen")]
    kinds = np.array([trial.kind for trial in faults])
    result = watch(with_limits(own.uncalibrated, own.limits["far1e-2"]), [trial.log for trial in faults])
    became = isolated(result, np.array([trial.column for trial in faults]))
    assert became.calm.mean() > 0.5
    right = {kind: became.right[became.calm & (kinds == kind)].mean() for kind in ("spike", "offset", "frozen")}
    assert became.right[became.calm].mean() >= 0.95
    assert min(right.values()) >= 0.88, right
    assert KALMAN not in {rival.method for rival in of_six_joints(APART)}
