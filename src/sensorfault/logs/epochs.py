"""Satellite epochs of a log: one row per epoch, with the inertial rows since the epoch before."""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import Channel, Log, LogError, Sensor

PLACE = ("x_m", "y_m", "z_m")
SPEED = ("vx_m_s", "vy_m_s", "vz_m_s")
ON_L1 = "GEJ"  # systems whose Doppler is of L1
RANGE, DOPPLER, CN0 = "corrected_m", "doppler_hz", "cn0_dbhz"
LATE = 5.0  # times its usual length: a longer row is a gap


class Epoch(NamedTuple):
    """Input of a navigation filter besides pseudoranges: T epochs of S satellites, R rows between two of them.

    Missing rows have length 0. `ok`: all six numbers arrived, and the row is not a gap.
    """

    gyro: Float[Any, "*T R 3"]  # turn rate in body axes [rad/s]
    force: Float[Any, "*T R 3"]  # specific force in body axes [m/s²]
    dt: Float[Any, "*T R"]  # [s]
    ok: Bool[Any, "*T R"]
    place: Float[Any, "*T S 3"]  # of satellites at transmission, ECEF of that time [m]
    speed: Float[Any, "*T S 3"]  # [m/s]
    cn0: Float[Any, "*T S"]  # [dB-Hz]
    ahead: Float[Any, "*T"]  # speed by the wheels [m/s], NaN without


class Cut(NamedTuple):
    """Epochs: their end times [s], the measurements of the satellites, which of them are new, and the rest."""

    time: Float[np.ndarray, " T"]
    value: Float[np.ndarray, "T C"]
    fresh: Bool[np.ndarray, "T C"]
    epoch: Epoch


@dataclass(frozen=True)
class Framing:
    """How a log becomes epochs: an epoch ends with the row in which a pseudorange is new, or with the R-th row.

    `satellites`: by name; those that the log lacks have no values. `inertial`: paths of gyro x, y, z and accelerometer
    x, y, z, or none. `wheel`: path of the wheel speed, or none. `rates`: also range rates, from the Dopplers on L1.
    `rows`: R. `tick_s`: the usual length of a row, `period_s`: of an epoch.
    """

    satellites: tuple[str, ...]
    inertial: tuple[str, ...]
    wheel: str
    rates: bool
    rows: int
    tick_s: float
    period_s: float

    @property
    def names(self) -> tuple[str, ...]:
        """Channels of a satellite that are judged."""
        return (RANGE, DOPPLER) if self.rates else (RANGE,)

    @property
    def channels(self) -> tuple[Channel, ...]:
        """All pseudoranges, then all Dopplers."""
        units = {RANGE: "m", DOPPLER: "Hz"}
        return tuple(Channel(name, one, units[name]) for name in self.names for one in self.satellites)

    @property
    def sensors(self) -> tuple[Sensor, ...]:
        """One a satellite."""
        return tuple(Sensor(one, self.period_s) for one in self.satellites)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Paths of all that is read of a log; what it lacks is absent."""
        each = (*self.names, *PLACE, *SPEED, CN0)
        wheel = (self.wheel,) if self.wheel else ()
        return (*self.inertial, *wheel, *(f"{one}.{name}" for one in self.satellites for name in each))

    @property
    def nothing(self) -> Epoch:
        """One epoch's block of the right shape, without measurements."""
        rows, satellites = self.rows, len(self.satellites)
        three = np.zeros((rows, 3))
        far = np.full((satellites, 3), np.nan)
        none = np.zeros(rows, bool)
        return Epoch(three, three, np.zeros(rows), none, far, far, np.full(satellites, np.nan), np.full((), np.nan))

    def frame(self, log: Log) -> Log:
        """The log as epochs, with an `Epoch` as its block.

        Raises:
            LogError: none of the satellites is in the log, or a channel of the inertial unit or the wheels is not.
        """
        at = {channel.path: i for i, channel in enumerate(log.channels)}
        missing = [path for path in (*self.inertial, *((self.wheel,) if self.wheel else ())) if path not in at]
        if missing or not any(f"{one}.{RANGE}" in at for one in self.satellites):
            lacks = missing[0] if missing else "corrected pseudorange of a satellite"
            raise LogError(
                f"{log.name} has no {lacks}, which this model was fitted on; name the columns in vehicle.toml, or fit "
                "a model on this log."
            )
        columns = [at.get(path, -1) for path in self.inputs]
        wide = np.column_stack((log.value, np.full(len(log), np.nan)))
        new = np.column_stack((log.fresh, np.zeros(len(log), bool)))
        return self._framed(log, wide[:, columns], new[:, columns])

    def _framed(self, log: Log, value: Float[np.ndarray, "T n"], fresh: Bool[np.ndarray, "T n"]) -> Log:
        """From the columns of `inputs`."""
        cut = self.cut(log.time, np.diff(log.time, prepend=log.time[:1]), value, fresh)
        return replace(
            log,
            time=cut.time,
            value=cut.value,
            fresh=cut.fresh,
            channels=self.channels,
            sensors=self.sensors,
            block=cut.epoch,
        )

    def cut(
        self,
        time: Float[np.ndarray, " T"],
        dt: Float[np.ndarray, " T"],
        value: Float[np.ndarray, "T n"],
        fresh: Bool[np.ndarray, "T n"],
    ) -> "Cut":
        """The epochs that end within these rows of `inputs`; `dt` is how long each row is [s]."""
        imu, wheel, sky, new = self._parted(value, fresh)
        ends = self.ends((new[:, :, 0] & np.isfinite(sky[:, :, 0])).any(axis=1))
        rows = self._rows(ends)
        there = rows >= 0
        length = np.where(there, dt[rows], 0.0)
        ok = there & np.isfinite(imu[rows]).all(axis=2) & (length < LATE * self.tick_s)
        inertial = np.where(ok[:, :, None], imu[rows], 0.0)
        many, at = len(self.names), sky[ends]
        judged = at[:, :, :many].transpose(0, 2, 1).reshape(len(ends), len(self.channels))
        marks = new[ends].transpose(0, 2, 1).reshape(judged.shape) & np.isfinite(judged)
        place, speed, cn0 = at[:, :, many : many + 3], at[:, :, many + 3 : many + 6], at[:, :, many + 6]
        epoch = Epoch(inertial[:, :, :3], inertial[:, :, 3:], length, ok, place, speed, cn0, wheel[ends])
        return Cut(time[ends], judged, marks, epoch)

    def _parted(self, value: Float[np.ndarray, "T n"], fresh: Bool[np.ndarray, "T n"]) -> tuple[Any, Any, Any, Any]:
        """Inertial rows (T, 6), wheel speed (T,), satellites' values (T, S, n), and which of them are new."""
        rows, lead = len(value), len(self.inertial) + bool(self.wheel)
        sky = value[:, lead:].reshape(rows, len(self.satellites), -1)
        if self.rates:
            sky = sky.copy()
            sky[:, [one[0] not in ON_L1 for one in self.satellites], self.names.index(DOPPLER)] = np.nan
        new = fresh[:, lead:].reshape(sky.shape)[:, :, : len(self.names)]
        imu = value[:, : len(self.inertial)] if self.inertial else np.full((rows, 6), np.nan)
        return imu, value[:, lead - 1] if self.wheel else np.full(rows, np.nan), sky, new

    def ends(self, received: Bool[np.ndarray, " T"]) -> Any:
        """Rows with which an epoch ends."""
        ends, since = [], 0
        for i, now in enumerate(received):
            since += 1
            if now or since == self.rows:
                ends.append(i)
                since = 0
        return np.array(ends, int)

    def _rows(self, ends: Any) -> Any:
        """Of each epoch the rows of the log, -1 where there is none."""
        first = np.concatenate([[0], ends[:-1] + 1])
        rows = first[:, None] + np.arange(self.rows)[None]
        return np.where(rows <= ends[:, None], rows, -1)


def framing(log: Log, satellites: tuple[str, ...], rates: bool, wheel: str = "") -> Framing:
    """How this log becomes epochs.

    Raises:
        LogError: fewer than two epochs.
    """
    inertial = tuple(f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz")
    have = {channel.path for channel in log.channels}
    ranges = [i for i, channel in enumerate(log.channels) if channel.name == RANGE]
    received = np.flatnonzero((log.fresh[:, ranges] & np.isfinite(log.value[:, ranges])).any(axis=1))
    if len(received) < 2:
        raise LogError(f"{log.name} has {len(received)} epochs with a pseudorange; give a longer part of it.")
    between = np.diff(received)
    usual = int(np.median(between))
    rows = 1 if usual == 1 else usual + max(2, usual // 20)
    return Framing(
        satellites,
        inertial if have.issuperset(inertial) else (),
        wheel,
        rates,
        rows,
        log.period_s,
        float(np.median(np.diff(log.time[received]))),
    )


class Gather:
    """Collects rows one by one until they make an epoch."""

    def __init__(self, framing: Framing) -> None:
        self._framing = framing
        self._rows: list[tuple[float, float, Any, Any]] = []
        self._last: float | None = None

    def push(self, time: float, value: Float[np.ndarray, " n"], fresh: Bool[np.ndarray, " n"]) -> Cut | None:
        """The epoch that ends with this row of `inputs`, if one does."""
        self._rows.append((time, 0.0 if self._last is None else time - self._last, value, fresh & np.isfinite(value)))
        self._last = time
        cut = self._framing.cut(*(np.array(column) for column in zip(*self._rows, strict=True)))
        if not len(cut.time):
            return None
        self._rows.clear()
        return cut
