"""A network that goes on learning while it watches two joints."""

import numpy as np

from laws.case import Case, limits_learned
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.methods.arm import online_network
from sensorfault.methods.arm.online_network import NAME, Setting
from sensorfault.runtime.runners import samples
from sensorfault.training.gradient import Plan
from sensorfault.training.online import Learning
from sensorfault.training.session import Session


def arm() -> Case:
    """Two joints, each a driven oscillator, that the network knows from 40 s, in the 8 s after them.

    Without the torques nothing can be predicted.
    """
    log = two_joints(2400)
    setting = Setting(learning=Learning(plan=Plan(epochs=20, rate=1e-2)))
    monitor = online_network.build(log.between(end_s=40.0), 0, Session(), setting).monitor
    part = log.between(40.0)
    lie = np.concatenate([0.1 * np.ptp(log.value[:, :4], axis=0), np.zeros(2)])
    outputs = (0, 1, 2, 3)
    return Case(
        NAME,
        monitor,
        samples(part.time, part.value, part.fresh),
        lie,
        back_s=float(monitor.recovery.horizon_s) + 0.1,
        learned=lambda state: (state.residual.network, limits_learned(state)),
        named=outputs,
        lost={4: outputs, 5: outputs},
    )


def two_joints(rows: int) -> Log:
    """Rates and angles of two joints at 50 Hz, and the torques that drive them."""
    random, dt = np.random.default_rng(8), 0.02
    torque = np.stack([np.sin(np.arange(rows) * dt * w) for w in (1.3, 2.1)], axis=1)
    rate, angle = np.zeros((rows, 2)), np.zeros((rows, 2))
    for k in range(1, rows):
        pull = torque[k] - 4 * np.sin(angle[k - 1]) - 0.5 * rate[k - 1] + 0.3 * rate[k - 1, ::-1]
        rate[k], angle[k] = rate[k - 1] + dt * pull, angle[k - 1] + dt * rate[k - 1]
    value = np.hstack([rate, angle, torque]) + [*[3e-3] * 4, 0, 0] * random.standard_normal((rows, 6))
    names = [("tachometer", "rate", "rad/s"), ("encoder", "angle", "rad"), ("drive", "torque", "N m")]
    channels = tuple(
        Channel(name, f"{sensor}{joint}", unit, watch=sensor != "drive")
        for sensor, name, unit in names
        for joint in (1, 2)
    )
    sensors = tuple(Sensor(channel.sensor, dt) for channel in channels)
    return Log(dt * np.arange(rows), value, np.ones(value.shape, bool), channels, sensors)


CASES = {NAME: arm}
