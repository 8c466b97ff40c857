"""What travels through a monitor: one sample, what was expected of it, how far off it was, and the verdict.

C channels (slots), S sensors, K tests. A channel belongs to one sensor; only the Monitor knows which.
"""

from typing import Any, NamedTuple

from jaxtyping import Array, Bool, Float, Int8

from sensorfault.core.verdicts import FAULT as FAULT
from sensorfault.core.verdicts import OK as OK
from sensorfault.core.verdicts import UNKNOWN as UNKNOWN

NEVER = -1e12  # a time before every clock's first tick [s]; finite, because a state never holds infinity


class Sample(NamedTuple):
    """One tick of the common clock.

    `present`: the slot holds a value. `fresh`: the value is a new measurement, not a held one (fresh <= present).
    `born`: the slot now carries another source (a satellite that rose), so what is remembered of the slot is void.
    `block`: private to the residual generator (IMU rows with their row_ok, satellite positions, control inputs), or ().
    """

    time: Float[Array, ""]  # [s]
    value: Float[Array, " C"]  # [SI]
    present: Bool[Array, " C"]
    fresh: Bool[Array, " C"]
    born: Bool[Array, " C"]
    block: Any = ()


class Residual(NamedTuple):
    """Measured minus expected, with what is known of its spread.

    `cov` comes from the filter or was fitted on healthy residuals; `noise` is the measurement variance in use.
    `valid`: testable now, that is fresh, finite and warmed up. `extra`: for statistics made for this residual only
    (bank members on a leading axis, several horizons). `out`: taken out of this sample by the Monitor, which sets it.
    """

    time: Float[Array, ""]
    value: Float[Array, " C"]
    cov: Float[Array, "C C"]
    measured: Float[Array, " C"]
    expected: Float[Array, " C"]
    noise: Float[Array, " C"]
    valid: Bool[Array, " C"]
    born: Bool[Array, " C"]
    extra: Any = ()
    out: Bool[Array, " C"] | bool = False


class Score(NamedTuple):
    """K tests: one a sample, one a channel, one a bank member or window.

    `covers`: the channels test k examined (its silence clears them). `blame`: those it accuses, 0 to 1.
    """

    value: Float[Array, " K"]
    valid: Bool[Array, " K"]
    covers: Bool[Array, "K C"]
    blame: Float[Array, "K C"]


class Evidence(NamedTuple):
    """All tests of one sample that judge sensors, branch by branch, as the decision sees them.

    `gates[b]`: whether an alarm of branch b may keep this sample out of a filter (a window's alarm may not).
    `certain[b]`: whether it accuses by itself, whatever the other channels say (an exact repeat does). `excluded`:
    channels already taken out of this sample, which stay accused. `born`: as in Sample.
    """

    time: Float[Array, ""]
    scores: tuple[Score, ...]
    limits: tuple[Float[Array, " K"], ...]
    gates: tuple[bool, ...]
    certain: tuple[bool, ...]
    excluded: Bool[Array, " C"]
    born: Bool[Array, " C"]


class Accusation(NamedTuple):
    """What a decision says of one sample.

    `named`: faulty. `gated`: named, and by a test that may keep it out of a filter; `certain`: by one that accuses by
    itself. `suspect`: over a limit, whether or not that is a fault yet, so that nothing is learned from it.
    `unattributed`: examined by a test that is over its limit and cannot say which channel causes it, so no channel it
    examined is cleared. `size` ranks the accused; it is -inf for all others. `tested`: examined by some test. `hit`:
    something is wrong, whether or not the channel is known.
    """

    named: Bool[Array, " C"]
    gated: Bool[Array, " C"]
    certain: Bool[Array, " C"]
    suspect: Bool[Array, " C"]
    unattributed: Bool[Array, " C"]
    size: Float[Array, " C"]
    tested: Bool[Array, " C"]
    hit: Bool[Array, ""]


class Verdict(NamedTuple):
    """OK, UNKNOWN or FAULT for each channel, each sensor and the sample, and for the motion of the vehicle.

    A sample at FAULT with no sensor at FAULT means: something is wrong, unknown which. A motion at FAULT means that
    healthy sensors saw the vehicle do what it cannot (skid, slip, be towed); it is no fault of the sample.
    """

    channel: Int8[Array, " C"]
    sensor: Int8[Array, " S"]
    sample: Int8[Array, ""]
    motion: Int8[Array, ""]


class Trust(NamedTuple):
    """What each stage may take in of this sample: three masks, because a filter, a window and a reference differ.

    `measured`: a filter may absorb it. `filled`: a window may take the stand-in in `value` (disjoint from measured).
    `learn`: references, thresholds and weights may learn from it.
    """

    value: Float[Array, " C"]
    measured: Bool[Array, " C"]
    filled: Bool[Array, " C"]
    learn: Bool[Array, " C"]
    born: Bool[Array, " C"]


class Report(NamedTuple):
    """All that a step found out. `silence`: time since the slot last held a value, before this sample [s]."""

    residual: Residual
    scores: tuple[Score, ...]
    limits: tuple[Float[Array, " K"], ...]
    verdict: Verdict
    trust: Trust
    silence: Float[Array, " C"]
