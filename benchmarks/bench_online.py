"""One live sample of the monitor of Niu & Zhao 1998 (predict, test, learn) against the same in PyTorch, and river.

An 8:5:4 network on the four sensors and two torques of two driven joints, one sample after the other: foretell the
increments, compare with limits, and up to ITERATIONS steps of backpropagation, fewer once the error is small. All have
the same data and bounds, and limits that nothing exceeds, so that they learn from every sample. PyTorch has autograd
and its SGD, the same network and one thread, which is its fastest. Ours also tells channel, sensor and sample, rebuilds
and keeps the events. river has no network any more: the same loop around a linear regression for each output, which is
less work, stands beside without a bar.

All take turns, ROUNDS times, and the fastest round's median counts, since other work on the machine only ever adds.
"""

import sys
from collections.abc import Callable
from time import perf_counter_ns

import numpy as np
import torch
from common import Bars, describe_machine
from river import linear_model, optim

import sensorfault as sf
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.methods.arm import online_network
from sensorfault.training.gradient import Plan
from sensorfault.training.online import Learning
from sensorfault.training.session import SILENT

TICK_S, TRAIN, ROWS, ROUNDS = 0.001, 4000, 1500, 6
ITERATIONS, RATE, FAR = 10, 0.3, 1e6
BAR_US, BAR_TIMES = 40.0, 5.0
PEERS = "PyTorch", "river"
OUTPUTS = "tachometer1.rate", "tachometer2.rate", "encoder1.angle", "encoder2.angle"


def two_joints(rows: int) -> Log:
    """Rates and angles of two driven joints with noise, and their torques."""
    random = np.random.default_rng(0)
    torque = np.stack([np.sin(np.arange(rows) * TICK_S * w) for w in (13.0, 21.0)], axis=1)
    rate, angle = np.zeros((rows, 2)), np.zeros((rows, 2))
    for k in range(1, rows):
        pull = 40 * torque[k] - 60 * np.sin(angle[k - 1]) - rate[k - 1] + 0.5 * rate[k - 1, ::-1]
        rate[k], angle[k] = rate[k - 1] + TICK_S * pull, angle[k - 1] + TICK_S * rate[k - 1]
    noise = random.standard_normal((rows, 6)) * [*[3e-3] * 4, 0, 0]
    names = [("tachometer", "rate"), ("encoder", "angle"), ("drive", "torque")]
    channels = tuple(
        Channel(name, f"{sensor}{joint}", watch=sensor != "drive") for sensor, name in names for joint in (1, 2)
    )
    sensors = tuple(Sensor(channel.sensor, TICK_S) for channel in channels)
    value = np.hstack([rate, angle, torque]) + noise
    return Log(TICK_S * np.arange(rows), value, np.ones(value.shape, bool), channels, sensors)


class Scaled:
    """Inputs and targets of our network, for the peers: y(k), u(k+1), u(k) on [-1, 1], and scaled increments."""

    def __init__(self, log: Log, model: sf.Model) -> None:
        own = model.monitor.residual
        unit = np.asarray(own.step)
        x = (log.value - np.asarray(own.center)) / np.asarray(own.half)
        self.x = np.hstack([x[:-1, :4], x[1:, 4:], x[:-1, 4:]])
        self.target = np.diff(log.value[:, :4], axis=0) / unit
        self.limit, self.tolerance = np.full(4, FAR), np.asarray(own.tolerance) / unit


class Torch:
    def __init__(self, data: Scaled) -> None:
        torch.set_num_threads(1)
        self.x, self.y = (torch.tensor(a, dtype=torch.float32) for a in (data.x, data.target))
        self.limit, self.tolerance = (torch.tensor(a, dtype=torch.float32) for a in (data.limit, data.tolerance))
        self.net = torch.nn.Sequential(torch.nn.Linear(8, 5), torch.nn.Tanh(), torch.nn.Linear(5, 4))
        self.sgd = torch.optim.SGD(self.net.parameters(), RATE / 10)
        self.steps = 0

    def push(self, k: int) -> None:
        x, y = self.x[k], self.y[k]
        e = y - self.net(x)
        if (e.detach().abs() > self.limit).any():
            return
        for _ in range(ITERATIONS):
            beyond = torch.nn.functional.softshrink(e / self.tolerance, 1.0) * self.tolerance
            if not beyond.detach().any():
                break
            self.sgd.zero_grad()
            (0.5 * (beyond**2).sum()).backward()
            self.sgd.step()
            self.steps += 1
            e = y - self.net(x)


class River:
    def __init__(self, data: Scaled) -> None:
        self.rows = [dict(enumerate(row)) for row in data.x.tolist()]
        self.y, self.limit, self.tolerance = (a.tolist() for a in (data.target, data.limit, data.tolerance))
        self.models = [linear_model.LinearRegression(optim.SGD(RATE / 10)) for _ in range(4)]
        self.steps = 0

    def push(self, k: int) -> None:
        x, y = self.rows[k], self.y[k]
        away = [abs(target - model.predict_one(x)) for model, target in zip(self.models, y, strict=True)]
        if any(a > most for a, most in zip(away, self.limit, strict=True)):
            return
        for _ in range(ITERATIONS):
            if all(a <= small for a, small in zip(away, self.tolerance, strict=True)):
                break
            for model, target in zip(self.models, y, strict=True):
                model.learn_one(x, target)
            self.steps += 1
            away = [abs(target - model.predict_one(x)) for model, target in zip(self.models, y, strict=True)]


def took(push: Callable[[int], object], rows: range) -> np.ndarray:
    """Time of each push [us]."""
    times = []
    for k in rows:
        start = perf_counter_ns()
        push(k)
        times.append(perf_counter_ns() - start)
    return np.array(times) / 1e3


def main() -> int:
    log = two_joints(TRAIN + ROWS * ROUNDS)
    train, test = log.between(end_s=TRAIN * TICK_S), log.between(TRAIN * TICK_S)
    learning = Learning(rate=RATE, iterations=ITERATIONS, plan=Plan(epochs=20, rate=1e-2))
    model = online_network.build(
        train, 0, SILENT, online_network.Setting(learning=learning, theta=dict.fromkeys(OUTPUTS, FAR))
    )
    live, data = sf.Live(model), Scaled(test, model)
    ours = ("sensorfault.Live.push, online-network", lambda k: live.push(test.time[k], test.value[k]))
    peers = Torch(data), River(data)
    racers = (ours, ("PyTorch, 8:5:4, SGD", peers[0].push), ("river, four linear regressions", peers[1].push))
    rounds: list[list[float]] = [[] for _ in racers]
    describe_machine()
    for r in range(ROUNDS):
        for medians, (_, push) in zip(rounds, racers, strict=True):
            medians.append(float(np.median(took(push, range(r * ROWS, (r + 1) * ROWS - 1)))))
    print(f"\n{'us a sample':48}{'best round':>12}{'median':>9}")
    for (name, _), medians in zip(racers, rounds, strict=True):
        print(f"{name:48}{min(medians):12.1f}{np.median(medians):9.1f}")
    steps = (f"{peer.steps / (ROUNDS * ROWS):.1f} by {name}" for name, peer in zip(PEERS, peers, strict=True))
    print(f"learning steps for each sample: {', '.join(steps)}\n")
    best, torch_us, _ = map(min, rounds)
    bars = Bars()
    bars.check(f"a live sample takes {best:.1f} us; bar {BAR_US:g}", best <= BAR_US)
    times = torch_us / best
    bars.check(f"{times:.1f} times faster than PyTorch; bar {BAR_TIMES:g}", times >= BAR_TIMES)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
