"""Two rigid links in a vertical plane, with a torque at each joint.

State: rates x1, x2 [rad/s] and angles x3, x4 [rad] of the joints, the first angle from the horizontal, the second from
the first link. NumPy and JAX arrays alike: whichever comes in goes out.
"""

from typing import Any, NamedTuple

from jaxtyping import Float

GRAVITY = 9.81  # [m/s^2]


class Constants(NamedTuple):
    """a1 to a5 of Niu & Zhao 1998, equation (4): the first three [kg m^2] of inertia, the others [N m] of weight."""

    a1: float
    a2: float
    a3: float
    a4: float
    a5: float


def constants(
    mass: tuple[float, float], length: float, centre: tuple[float, float], inertia: tuple[float, float]
) -> Constants:
    """Of any two links: masses [kg], length of the first [m], from each joint to its link's centre of mass [m], moments
    of inertia about these centres [kg m^2].
    """
    (m1, m2), (c1, c2), (i1, i2) = mass, centre, inertia
    return Constants(
        a1=m1 * c1**2 + i1 + m2 * (length**2 + c2**2) + i2,
        a2=2 * m2 * length * c2,
        a3=m2 * c2**2 + i2,
        a4=GRAVITY * (m1 * c1 + m2 * length),
        a5=GRAVITY * m2 * c2,
    )


def accelerations(a: Constants | Float[Any, "5"], state: Float[Any, "4"], torque: Float[Any, "2"]) -> Float[Any, "2"]:
    """Of both joints [rad/s^2], torques in [N m]. Niu & Zhao 1998, equations (3) and (4).

    The matrix of inertia is [[D, E], [E, a3]], C its determinant; A and B are what is left of the torques.
    """
    xp = state.__array_namespace__()
    x1, x2, x3, x4 = (state[i] for i in range(4))
    a1, a2, a3, a4, a5 = (a[i] for i in range(5))
    cos, sin = xp.cos(x4), xp.sin(x4)
    weight = a5 * xp.cos(x3 + x4)
    # (4)
    d = a1 + a2 * cos
    e = a3 + a2 * cos / 2
    left = a2 * sin * (x1 * x2 + x2**2 / 2) - a4 * xp.cos(x3) - weight + torque[0]
    right = -a2 * sin * x1**2 / 2 - weight + torque[1]
    c = d * a3 - e**2
    # (3), which is missing in the printed paper
    return xp.stack([(a3 * left - e * right) / c, (d * right - e * left) / c])


def ahead(a: Constants | Float[Any, "5"], state: Float[Any, "4"], torque: Float[Any, "2"], dt: Any) -> Float[Any, "4"]:
    """The state `dt` [s] later by Euler's step, as printed: x⁺ = x + T (acceleration, rate). Niu & Zhao 1998, (3)."""
    xp = state.__array_namespace__()
    return state + dt * xp.concat([accelerations(a, state, torque), state[:2]])
