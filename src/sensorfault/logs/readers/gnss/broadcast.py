"""Broadcast ephemerides: the position and the clock of each satellite at any time."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple, TypeVar

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.readers.source import Damage
from sensorfault.numerics.gnss import glonass, kepler
from sensorfault.numerics.gnss.glonass import GlonassEphemeris
from sensorfault.numerics.gnss.kepler import Ephemeris

E = TypeVar("E", bound=Ephemeris | GlonassEphemeris)
# How far from its reference time an ephemeris is good [s].
_GOOD_S: dict[type, float] = {Ephemeris: 7_260.0, GlonassEphemeris: 1_800.0}
_SQRT_A = (4_000.0, 7_500.0)  # [√m]
_STATE_M = (2.0e7, 3.0e7)  # from the centre of the earth
_AGREE_M = 2_000.0  # two of one satellite, each in reach of the other's time


class Satellite(NamedTuple):
    """One satellite at T times, in the earth's frame of each time; NaN where no ephemeris is good."""

    position: Float[np.ndarray, "T 3"]  # ECEF [m]
    velocity: Float[np.ndarray, "T 3"]  # [m/s]
    clock: Float[np.ndarray, " T"]  # ahead of GPS time, for users of the first frequency [s]


@dataclass(frozen=True)
class Broadcast:
    """Ephemerides by satellite (`G07`, `R12`, `E30`, `C20`), each a stack of K; `klobuchar`: α0-3 and β0-3, or None."""

    kepler: Mapping[str, Ephemeris] = field(default_factory=dict)
    glonass: Mapping[str, GlonassEphemeris] = field(default_factory=dict)
    klobuchar: Float[np.ndarray, "8"] | None = None
    odd: tuple[str, ...] = ()  # satellites of which an ephemeris was left out
    damage: tuple[Damage, ...] = ()

    @property
    def satellites(self) -> tuple[str, ...]:
        """All that have ephemerides, by name."""
        return tuple(sorted((*self.kepler, *self.glonass)))

    @property
    def times(self) -> Float[np.ndarray, " K"]:
        """The reference times of all ephemerides [s of GPS time]."""
        orbits, states = [each.toe for each in self.kepler.values()], [each.toe for each in self.glonass.values()]
        return np.concatenate([*orbits, *states])

    def at(self, satellite: str, time: Float[np.ndarray, " T"]) -> Satellite:
        """A satellite at the times of transmission [s of GPS time], by the ephemeris of the nearest reference time.

        Afterwards that may be one which had not been broadcast yet: as post-processing does it.
        """
        found = self.kepler.get(satellite) or self.glonass.get(satellite)
        if found is None:
            nowhere = np.full((len(time), 3), np.nan)
            return Satellite(nowhere, nowhere, np.full(len(time), np.nan))
        nearest = np.abs(time[:, None] - found.toe).argmin(axis=1)
        old = np.abs(time - found.toe[nearest]) > _GOOD_S[type(found)]
        position, velocity, clock = _at(_rows(found, nearest), time)
        position[old], velocity[old], clock[old] = np.nan, np.nan, np.nan
        return Satellite(position, velocity, clock)

    def with_more(self, other: "Broadcast") -> "Broadcast":
        """This one, and what it lacks from another."""
        own = self.klobuchar if self.klobuchar is not None else other.klobuchar
        odd = tuple(dict.fromkeys((*self.odd, *other.odd)))
        return Broadcast({**other.kepler, **self.kepler}, {**other.glonass, **self.glonass}, own, odd)


def gathered(
    orbits: Mapping[str, list[Ephemeris]], states: Mapping[str, list[GlonassEphemeris]], klobuchar: np.ndarray | None
) -> Broadcast:
    """Each satellite's ephemerides by their reference times; those that contradict the others are left out."""
    kept_orbits = {name: _stacked(each) for name, each in _sane(orbits, _is_orbit)}
    kept_states = {name: _stacked(each) for name, each in _sane(states, _is_state)}
    odd = (*_without_odd(kept_orbits), *_without_odd(kept_states))
    return Broadcast(kept_orbits, kept_states, klobuchar, odd)


def _sane(each: Mapping[str, list[E]], is_sane: Callable[[E], bool]) -> list[tuple[str, list[E]]]:
    """The satellites that have any, with those that are."""
    kept = ((name, [one for one in ones if is_sane(one)]) for name, ones in each.items())
    return [(name, ones) for name, ones in kept if ones]


def _is_orbit(one: Ephemeris) -> bool:
    """Whether damage has left an orbit round the earth, of the size that navigation satellites have."""
    finite = bool(np.isfinite(np.array(one, float)).all())
    return finite and _SQRT_A[0] < one.sqrt_a < _SQRT_A[1] and 0 <= one.eccentricity < 0.5 and _is_date(one.toe)


def _is_state(one: GlonassEphemeris) -> bool:
    """Whether damage has left a satellite where those of GLONASS are."""
    finite = all(np.isfinite(np.array(value, float)).all() for value in one)
    return finite and _STATE_M[0] < float(np.linalg.norm(one.start)) < _STATE_M[1] and _is_date(one.toe)


def _is_date(time: float) -> bool:
    return 0 <= time < 100 * 365.25 * 86_400


def _without_odd(kept: dict[str, E]) -> list[str]:
    """Take the ephemerides out that are not sound; the satellites that had some."""
    sound = {name: _sound(each) for name, each in kept.items()}
    odd = [name for name, good in sound.items() if not good.all()]
    for name in odd:
        if sound[name].any():
            kept[name] = _rows(kept[name], np.flatnonzero(sound[name]))
        else:
            del kept[name]
    return odd


def _stacked(each: list[E]) -> E:
    each = sorted(each, key=lambda one: float(one.toe))
    return type(each[0])(*(np.array(values, float) for values in zip(*each, strict=True)))


def _rows(stack: E, rows: np.ndarray) -> E:
    return type(stack)(*(values[rows] for values in stack))


def _at(own: Ephemeris | GlonassEphemeris, time: np.ndarray) -> Satellite:
    if isinstance(own, GlonassEphemeris):
        return Satellite(*glonass.state(own, time), glonass.clock(own, time))
    return Satellite(kepler.position(own, time), kepler.velocity(own, time), kepler.clock(own, time))


def _sound(stack: Ephemeris | GlonassEphemeris) -> Bool[np.ndarray, " K"]:
    """Which place the satellite near where one of the two that are nearest in time has it.

    Files of a day hold a foreign satellite's ephemeris now and then: 20,000 km off (G14 and R24 on 2016-06-06).
    """
    count = len(stack.toe)
    away = np.abs(stack.toe[:, None] - stack.toe)
    np.fill_diagonal(away, np.inf)
    two = np.argsort(away, axis=1, kind="stable")[:, :2]
    if two.shape[1] < 2:
        return np.ones(count, bool)
    own = _at(stack, stack.toe).position
    theirs = [_at(_rows(stack, other), stack.toe).position for other in two.T]
    far = np.linalg.norm(own - np.stack(theirs), axis=2) > _AGREE_M
    near = np.take_along_axis(away, two, axis=1) < 2 * _GOOD_S[type(stack)]
    sound: Bool[np.ndarray, " K"] = ~(far.all(axis=0) & near.all(axis=1))
    return sound
