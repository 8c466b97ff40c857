"""A vehicle under water with dead reckoning and acoustic ranges to its leaders."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Sample
from sensorfault.logs.table import Log
from sensorfault.numerics.columns import picked
from sensorfault.numerics.geodesy import ECCENTRICITY_SQUARED, SEMI_MAJOR_AXIS
from sensorfault.numerics.local import east_north, on_the_map
from sensorfault.vehicles.follower_columns import follower_columns

UNKNOWN_SPEED = 2.0  # standard deviation of a velocity that nothing measures [m/s]
GAP_S = 5.0  # after a longer gap of the clock the velocity counts as unknown [s]
LOST_M = 2000.0  # with a larger position uncertainty, ranges cannot correct the filter any more [m]


class Leader(eqx.Module):
    """Columns of one leader: the range to it, its reported position (north or latitude first), and its depth."""

    range: int = eqx.field(static=True)
    position: tuple[int, ...] = eqx.field(static=True)
    depth: int | None = eqx.field(static=True, default=None)


class FollowerRoles(eqx.Module):
    """Columns of a log that describe a follower; empty or None where the log has no such channel.

    `position`: of the follower itself (a sensor without a range), north or latitude first; its initial position.
    `velocity`: forward and to the right. `geodetic`: positions are latitudes and longitudes, else metres on a plane.
    """

    leaders: tuple[Leader, ...] = ()
    position: tuple[int, ...] = eqx.field(static=True, default=())
    velocity: tuple[int, ...] = eqx.field(static=True, default=())
    heading: int | None = eqx.field(static=True, default=None)
    depth: int | None = eqx.field(static=True, default=None)
    geodetic: bool = eqx.field(static=True, default=True)


def roles(log: Log) -> FollowerRoles:
    """The columns that `follower_columns` finds."""
    found = follower_columns(log)
    return FollowerRoles(tuple(Leader(*one) for one in found.leaders), *found[1:])


class Follower(eqx.Module):
    """State: latitude and longitude [rad], or north and east [m]. Xu et al. 2023, (1)-(5), on the ellipsoid itself.

    The distance to a leader is a difference of angles times the radii between the two. The printed (3) and (4) multiply
    each absolute longitude by its own radius, which turns 300 m to the north at 45 degrees into 563 m. Ranges are slant
    ranges, so h contains the depths. `q`: variance that one second of dead reckoning adds [m²/s]; `start_m`: standard
    deviation of the initial fix.
    """

    q: Float[Array, ""]
    start_m: Float[Array, ""]
    roles: FollowerRoles

    @property
    def observed(self) -> tuple[int, ...]:
        """Columns of the ranges."""
        return tuple(leader.range for leader in self.roles.leaders)

    def start(self, sample: Sample) -> tuple[Float[Array, "2"], Float[Array, "2"], Bool[Array, ""]]:
        state = picked(sample.value, self.roles.position)
        spread = self.start_m / self._metres(state)
        return state, spread, picked(sample.fresh, self.roles.position).all() & self._there(state)

    def ahead(self, state: Float[Array, "2"], sample: Sample, dt: Float[Array, ""]) -> Float[Array, "2"]:
        if not self.roles.velocity or self.roles.heading is None:
            return state
        v, w = picked(sample.value, self.roles.velocity)
        heading = sample.value[self.roles.heading]
        c, s = jnp.cos(heading), jnp.sin(heading)
        # (1) L⁺ = L + Δt (v cos θ - ω sin θ) / R_M,  λ⁺ = λ + Δt (v sin θ + ω cos θ) / (R_N cos L)
        way = jnp.stack([v * c - w * s, v * s + w * c]) * dt
        return state + jnp.where(self._reckoned(sample), way, 0.0) / self._metres(state)

    def noise(
        self, state: Float[Array, "2"], spread: Float[Array, "2"], sample: Sample, dt: Float[Array, ""]
    ) -> Float[Array, "2"]:
        known = self._reckoned(sample) & (dt <= GAP_S)
        # an unknown speed stays the same from tick to tick: (σ + u Δt)² - σ²
        way = UNKNOWN_SPEED * dt
        unknown = way * (way + 2 * spread * self._metres(state))
        return jnp.sqrt(self.q * dt + jnp.where(known, 0.0, unknown)) / self._metres(state)

    def expected(self, state: Float[Array, "2"], sample: Sample) -> Float[Array, " M"]:
        ranges = []
        for leader in self.roles.leaders:
            at = picked(sample.value, leader.position)
            away = east_north(*at, *state) if self.roles.geodetic else at - state
            deeper = jnp.zeros(())
            if leader.depth is not None and self.roles.depth is not None:
                deeper = sample.value[leader.depth] - sample.value[self.roles.depth]
            # (3), (4) r = √(Δn² + Δe² + Δh²)
            ranges.append(jnp.sqrt((away**2).sum() + deeper**2))
        return jnp.stack(ranges)

    def ready(self, sample: Sample) -> Bool[Array, " M"]:
        known = []
        for leader in self.roles.leaders:
            needed = [*leader.position]
            if leader.depth is not None and self.roles.depth is not None:
                needed += [leader.depth, self.roles.depth]
            known.append(
                picked(sample.present, tuple(needed)).all() & self._there(picked(sample.value, leader.position))
            )
        return jnp.stack(known)

    def lost(self, state: Float[Array, "2"], spread: Float[Array, "2"]) -> Bool[Array, ""]:
        return (spread * self._metres(state)).max() > LOST_M

    def _there(self, position: Float[Array, "2"]) -> Bool[Array, ""]:
        return on_the_map(*position) if self.roles.geodetic else jnp.isfinite(position).all()

    def _reckoned(self, sample: Sample) -> Bool[Array, ""]:
        """Whether velocity and heading are present."""
        if not self.roles.velocity or self.roles.heading is None:
            return jnp.ones((), bool)  # a random walk, which q describes
        return picked(sample.present, (*self.roles.velocity, self.roles.heading)).all()

    def _metres(self, state: Float[Array, "2"]) -> Float[Array, "2"]:
        """How many metres one unit of the state is, to the north and to the east."""
        if not self.roles.geodetic:
            return jnp.ones(2)
        # R_N = a / √(1 - e² sin²L),  R_M = R_N³ (1 - e²) / a²
        n = SEMI_MAJOR_AXIS / jnp.sqrt(1 - ECCENTRICITY_SQUARED * jnp.sin(state[0]) ** 2)
        return jnp.stack([n**3 * (1 - ECCENTRICITY_SQUARED) / SEMI_MAJOR_AXIS**2, n * jnp.cos(state[0])])
