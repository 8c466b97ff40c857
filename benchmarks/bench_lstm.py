"""Training and inference of the LSTM of Min et al. 2021 (8 inputs, 2 layers of 16, windows of 30) against nn.LSTM.

Training: one epoch over the same 27,000 windows, in batches of BATCH drawn in a new order, mean square error, Adam;
both shuffle, gather their windows and keep to float32. PyTorch has two threads and its fastest settings: Adam fused,
windows copied out beforehand, the batch first or second. Live: one window in, one prediction out as NumPy; ours in
float64, as a monitor runs it, PyTorch in float32 and inference mode.

Both take turns, ROUNDS times, and the fastest of each counts, since other work on the machine only ever adds.
"""

import sys
from time import perf_counter

import jax
import jax.numpy as jnp
import numpy as np
import torch
from common import Bars, describe_machine, seconds

from sensorfault.training.gradient import begin, one_epoch
from sensorfault.training.initial import new_lstm
from sensorfault.training.windows import Windows

WINDOWS, LENGTH, INPUTS, OUTPUTS, CELLS = 27_000, 30, 8, 2, 16
BATCH, RATE = 64, 1e-3
ROUNDS = 6
BAR_EPOCH = 0.8
BAR_LIVE = 4


class Peer(torch.nn.Module):
    def __init__(self, batch_first: bool) -> None:
        super().__init__()
        self.batch_first = batch_first
        self.lstm = torch.nn.LSTM(INPUTS, CELLS, 2, batch_first=batch_first)
        self.output = torch.nn.Linear(CELLS, OUTPUTS)

    def forward(self, window: torch.Tensor) -> torch.Tensor:
        result = self.lstm(window)[0]
        return self.output(result[:, -1] if self.batch_first else result[-1])

    def __str__(self) -> str:
        return f"PyTorch, batch {'first' if self.batch_first else 'second'}"


class PeerTraining:
    def __init__(self, windows: Windows, batch_first: bool) -> None:
        self.net = Peer(batch_first)
        self.adam = torch.optim.Adam(self.net.parameters(), RATE, fused=True)
        self.x = torch.tensor(windows.matrix().reshape(-1, LENGTH, INPUTS), dtype=torch.float32)
        self.y = torch.tensor(windows.target, dtype=torch.float32)

    def epoch(self) -> None:
        order = torch.randperm(WINDOWS)
        for start in range(0, WINDOWS - BATCH + 1, BATCH):
            chosen = order[start : start + BATCH]
            x = self.x[chosen]
            self.adam.zero_grad()
            result = self.net(x if self.net.batch_first else x.transpose(0, 1))
            torch.nn.functional.mse_loss(result, self.y[chosen]).backward()
            self.adam.step()


class OurTraining:
    def __init__(self, windows: Windows) -> None:
        self.now = begin(new_lstm(0, INPUTS, OUTPUTS, (CELLS, CELLS)), RATE)
        self.examples = windows.on_device()
        self.random = np.random.default_rng(0)

    def epoch(self) -> None:
        order = self.random.permutation(WINDOWS)[: WINDOWS // BATCH * BATCH]
        batches = jnp.asarray(order.reshape(-1, BATCH), jnp.int32)
        self.now, error = one_epoch(self.now, self.examples, batches, LENGTH)
        jax.block_until_ready(error)


def motion() -> Windows:
    """Eight smooth signals; their values do not matter for the time."""
    random = np.random.default_rng(0)
    rows = np.tanh(np.cumsum(random.standard_normal((WINDOWS + LENGTH, INPUTS)), axis=0) / 50)
    first = np.arange(WINDOWS)
    return Windows(rows, first, rows[first + LENGTH, :OUTPUTS], LENGTH)


def epochs(windows: Windows) -> float:
    """Our time for an epoch divided by PyTorch's."""
    ours, peers = OurTraining(windows), [PeerTraining(windows, batch_first) for batch_first in (True, False)]
    start = perf_counter()
    ours.epoch()
    compile_s = perf_counter() - start
    took = np.array([[seconds(one.epoch, 1)[0] for one in (ours, *peers)] for _ in range(ROUNDS)])
    print(f"\n{f'epoch of {WINDOWS} windows, batches of {BATCH}':48}{'best s':>9}{'median s':>10}")
    for name, one in zip(("sensorfault", *(str(peer.net) for peer in peers)), took.T, strict=True):
        print(f"{name:48}{one.min():9.3f}{np.median(one):10.3f}")
    print(f"(compiled in {compile_s:.1f} s, once)")
    best = took.min(axis=0)
    return float(best[0] / best[1:].min())


def live(windows: Windows) -> float:
    """PyTorch's time for a prediction divided by ours."""
    net = new_lstm(0, INPUTS, OUTPUTS, (CELLS, CELLS))
    compiled = jax.jit(net.__call__)
    peers = [Peer(batch_first).eval() for batch_first in (True, False)]
    window = windows.rows[:LENGTH]
    inputs = [torch.tensor(window[None], dtype=torch.float32), torch.tensor(window[:, None], dtype=torch.float32)]
    np.asarray(compiled(window))
    ours, theirs = [], [[], []]
    with torch.inference_mode():
        for _ in range(ROUNDS):
            ours.append(np.median(seconds(lambda: np.asarray(compiled(window)), 500)))
            for peer, x, rounds in zip(peers, inputs, theirs, strict=True):
                rounds.append(np.median(seconds(lambda peer=peer, x=x: peer(x).numpy(), 500)))
    print(f"\n{'one window':48}{'best us':>9}")
    print(f"{'sensorfault':48}{min(ours) * 1e6:9.1f}")
    for peer, rounds in zip(peers, theirs, strict=True):
        print(f"{peer!s:48}{min(rounds) * 1e6:9.1f}")
    print("(each the best of the rounds' medians)\n")
    return float(min(map(min, theirs)) / min(ours))


def main() -> int:
    torch.set_num_threads(2)
    windows = motion()
    describe_machine()
    ratio = epochs(windows)
    times = live(windows)
    bars = Bars()
    bars.check(f"an epoch takes {ratio:.2f} of PyTorch's time; bar {BAR_EPOCH}", ratio <= BAR_EPOCH)
    bars.check(f"a live window is {times:.1f} times faster than PyTorch's; bar {BAR_LIVE}", times >= BAR_LIVE)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
