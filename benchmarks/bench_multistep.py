"""All trainings of Wang S. et al., one network for each N = 1 .. 15, against PyTorch, one after the other.

The same windows, batches of 32, Adam, step weights and schedule. Ours is timed whole, compilation and early stop and
all. PyTorch (autograd, one thread, which is its fastest at this size) takes EPOCHS epochs of some N; what it would need
for as many epochs as ours took is counted up from them, linear in N.
"""

import sys
from time import perf_counter

import numpy as np
import torch
from common import DATA, Bars, describe_machine

from sensorfault.training.fixes import Fixes
from sensorfault.training.multistep import HIDDEN, train_steps
from sensorfault_studies.multistep.flights import flight
from sensorfault_studies.multistep.flown import Flown

STEPS, SOME, EPOCHS = tuple(range(1, 16)), (1, 8, 15), 2
BAR_S, BAR_TIMES = 60.0, 5.0
ROWS, FIX_S = 1836, 0.2  # of the real flight


def fixes() -> Fixes:
    """The first 70 % of the real flight; without it, as many simulated fixes."""
    if (DATA / "uav" / "px4_fw_proto_flt09").is_dir():
        learn = Flown.of(flight("proto")).learn
        return Fixes.of(learn, 0, (1, 3, 4, 5))
    print(f"{DATA / 'uav'} does not exist (set SENSORFAULT_DATA): a simulated flight is used.")
    random = np.random.default_rng(0)
    inputs = np.sin(np.outer(np.arange(ROWS) * FIX_S, (0.3, 0.7, 1.1, 0.2))) + 0.1 * random.standard_normal((ROWS, 4))
    height = 300 + np.cumsum(inputs[:, 0]) * FIX_S + 0.05 * random.standard_normal(ROWS)
    return Fixes(FIX_S * np.arange(ROWS), height, inputs, (1, 2, 3, 4), 2.0, "simulated")


class Torch:
    """The network of N steps, on the same scaled windows."""

    def __init__(self, data: Fixes, steps: int) -> None:
        torch.set_num_threads(1)
        torch.manual_seed(0)
        center, half, unit = data.scale()
        seen = (np.column_stack([data.height, data.inputs]) - center) / half
        at = data.windows(max(STEPS))[:, None] + np.arange(steps + 1)
        self.height, self.inputs = (torch.tensor(x[at], dtype=torch.float32) for x in (seen[:, 0], seen[:, 1:]))
        self.dt = torch.tensor(np.diff(data.time[at]) / data.period_s, dtype=torch.float32)
        self.unit, self.steps = unit / half[0], steps
        weight = np.arange(steps, 0, -1.0)
        self.weight = torch.tensor(weight / weight.sum(), dtype=torch.float32)
        self.net = torch.nn.Sequential(
            torch.nn.Linear(len(center), HIDDEN), torch.nn.ReLU(), torch.nn.Linear(HIDDEN, 1)
        )
        self.adam = torch.optim.Adam(self.net.parameters(), 1e-3)

    def epoch(self) -> None:
        order = torch.randperm(len(self.height))
        for k in range(len(order) // 32):
            rows = order[32 * k : 32 * k + 32]
            h, loss = self.height[rows, 0], torch.zeros(())
            for j in range(self.steps):
                x = torch.cat([h[:, None], self.inputs[rows, j]], dim=1).clamp(-2, 2)
                h = h + self.unit * self.dt[rows, j] * self.net(x)[:, 0]
                loss = loss + self.weight[j] * (((h - self.height[rows, j + 1]) / self.unit) ** 2).mean()
            self.adam.zero_grad()
            loss.backward()
            self.adam.step()


def main() -> int:
    describe_machine()
    data = fixes()
    start = perf_counter()
    trained = train_steps(data, STEPS)
    ours = perf_counter() - start
    epochs = np.isfinite(trained.loss[0]).sum(axis=1)
    print(f"\nsensorfault: {len(STEPS)} trainings of {epochs.min()} to {epochs.max()} epochs, {ours:.1f} s")
    each = []
    for n in SOME:
        peer = Torch(data, n)
        peer.epoch()
        start = perf_counter()
        for _ in range(EPOCHS):
            peer.epoch()
        each.append((perf_counter() - start) / EPOCHS)
        print(f"PyTorch: an epoch of N = {n} takes {each[-1]:.2f} s")
    theirs = float(np.interp(STEPS, SOME, each) @ epochs)
    print(f"PyTorch, all {len(STEPS)} with as many epochs: {theirs:.0f} s\n")
    bars = Bars()
    bars.check(f"{len(STEPS)} trainings take {ours:.1f} s; bar {BAR_S:g}", ours <= BAR_S)
    bars.check(f"{theirs / ours:.1f} times faster than PyTorch; bar {BAR_TIMES:g}", theirs / ours >= BAR_TIMES)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
