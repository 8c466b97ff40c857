from dataclasses import replace

import numpy as np
import pytest

from sensorfault.simulation.arm import AS_PRINTED, PERIOD_S, PHYSICAL, VARIANCE, Setting, motion, run, torques


@pytest.mark.parametrize("setting", [AS_PRINTED, PHYSICAL])
def test_the_start_gives_the_papers_thresholds(setting: Setting) -> None:
    """The largest slope times T and three standard deviations: 0.024 for rate y2, 0.0182 for angle y4."""
    log = motion(setting)
    assert log.period_s == pytest.approx(PERIOD_S)
    assert len(log) == 100
    limits = np.abs(np.diff(log.value, axis=0)).max(axis=0) + 3 * np.sqrt(VARIANCE)
    assert limits[1] == pytest.approx(0.024, abs=7e-4)
    assert limits[3] == pytest.approx(0.0182, abs=1e-4)


def test_from_rest_the_printed_input_throws_the_arm_about() -> None:
    steps = np.abs(np.diff(motion(replace(AS_PRINTED, start=(0.0, 0.0, 0.0, 0.0))).value, axis=0))
    assert 0.4 < steps[:, 1].max() < 0.6


def test_inputs_are_as_printed() -> None:
    k = np.arange(100)
    np.testing.assert_allclose(torques(AS_PRINTED, 100)[:, 0], 125 - 5 * (1 - np.exp(-0.2 * k)))
    np.testing.assert_allclose(torques(AS_PRINTED, 100)[:, 1], 125 - 10 * (1 - np.exp(-0.2 * k)))
    np.testing.assert_allclose(torques(PHYSICAL, 100)[:, 1], 25 - 10 * (1 - np.exp(-0.2 * k)))


def test_names_and_roles() -> None:
    log = run()
    paths = [f"{sensor}{joint}" for sensor in ("tachometer", "encoder", "drive") for joint in (1, 2)]
    assert [sensor.name for sensor in log.sensors] == paths
    assert [channel.name for channel in log.channels] == ["rate", "rate", "angle", "angle", "torque", "torque"]
    assert [channel.watch for channel in log.channels] == [True] * 4 + [False] * 2


def test_noise_of_sensors_is_not_noise_of_the_arm() -> None:
    true = motion(AS_PRINTED).value
    noise = np.concatenate([run(seed=seed).value - true for seed in range(50)])
    np.testing.assert_allclose(noise[:, :4].var(axis=0), VARIANCE, rtol=0.1)
    assert (noise[:, 4:] == 0).all()
    np.testing.assert_array_equal(run(seed=3).value, run(seed=3).value)
    moved = run(seed=0, variance=0.0, process=VARIANCE).value[:, :4] - true[:, :4]
    assert np.abs(moved[-1]).max() > 5 * np.sqrt(VARIANCE)  # it adds up
    assert run(seed=0, variance=0.0).value == pytest.approx(true)
    assert len(run(samples=300)) == 300
