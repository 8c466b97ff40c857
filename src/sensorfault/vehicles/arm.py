"""A robot arm: the channels of its joints, and the motion of two joints in a vertical plane."""

from dataclasses import dataclass

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.logs.table import Log
from sensorfault.logs.units import si_unit
from sensorfault.numerics.two_link import Constants, ahead


@dataclass(frozen=True)
class Joints:
    """Columns of the rates, angles and torques of an arm's joints, in the log's order."""

    rates: tuple[int, ...]
    angles: tuple[int, ...]
    torques: tuple[int, ...]


def joints(log: Log) -> Joints:
    """Channels called `rate`, `angle` and `torque`, at most one of each for a joint."""

    def called(name: str, unit: str) -> tuple[int, ...]:
        return tuple(i for i, c in enumerate(log.channels) if c.name == name and si_unit(c.unit) == unit)

    return Joints(called("rate", "rad/s"), called("angle", "rad"), called("torque", "Nm"))


class TwoLink(eqx.Module):
    """An arm of two joints, by its five constants. Niu & Zhao 1998, equations (3) and (4)."""

    a: Float[Array, "5"]

    @classmethod
    def of(cls, constants: Constants) -> "TwoLink":
        """With these constants."""
        return cls(jnp.asarray(constants, float))

    def ahead(self, state: Float[Array, "4"], torque: Float[Array, "2"], dt: Float[Array, ""]) -> Float[Array, "4"]:
        """Rates [rad/s] and angles [rad] after `dt` [s] under these torques [N m]."""
        return jnp.asarray(ahead(self.a, state, torque, dt))
