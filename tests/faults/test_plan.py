import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from faults.example import example
from sensorfault.faults.fault import KINDS, Fault, FaultError
from sensorfault.faults.inject import inject
from sensorfault.faults.plan import plan, sweep

LOG = example(6000)  # 600 s


def test_a_sweep_is_every_kind_on_every_watched_channel() -> None:
    faults = sweep(LOG)
    assert {(f.kind, f.where) for f in faults} == {
        (kind, path) for kind in KINDS for path in ("gyro.x", "gyro.z", "gnss.speed", "baro.pressure")
    }
    assert [f.where for f in sweep(LOG, ["frozen"], ["gnss.latitude"])] == ["gnss.latitude"]
    with pytest.raises(FaultError, match="kind 'melt' is unknown"):
        sweep(LOG, ["melt"])


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(0.5, 30.0), min_size=1, max_size=8), st.integers(0, 5), st.floats(0.0, 200.0))
def test_planned_faults_keep_their_distance(lasting: list[float], seed: int, start_s: float) -> None:
    wanted = [Fault("frozen", "gyro", "z", 0.0, duration) for duration in lasting]
    planned = plan(LOG, wanted, start_s=start_s, end_s=590.0, pause_s=12.0, seed=seed)
    assert sorted(f.duration_s for f in planned) == sorted(lasting)
    ends = [start_s, *(f.end_s for f in planned)]
    starts = [*(f.start_s for f in planned), 590.0]
    assert all(start - end >= 12.0 - 1e-9 for end, start in zip(ends, starts, strict=True))
    assert planned == plan(LOG, wanted, start_s=start_s, end_s=590.0, pause_s=12.0, seed=seed)
    assert planned != plan(LOG, wanted, start_s=start_s, end_s=590.0, pause_s=12.0, seed=seed + 1)


def test_a_planned_sweep_can_be_injected() -> None:
    planned = plan(LOG, sweep(LOG, duration_s=5.0), start_s=100.0, pause_s=8.0)
    assert len(inject(LOG, planned).truth) == len(planned) == 32


def test_too_much_is_refused_in_a_sentence() -> None:
    with pytest.raises(FaultError, match=r"3 faults with pauses of 10 s need 640 s, but there are 599\.9 s"):
        plan(LOG, [Fault("frozen", "gyro", "z", 0.0, 200.0)] * 3)
