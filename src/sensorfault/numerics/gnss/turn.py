"""Coordinates in rotated axes."""

from typing import Any

from jaxtyping import Float

from sensorfault.numerics.gnss.namespace import namespace

Numbers = float | Float[Any, "*#n"]


def turn(first: Numbers, second: Numbers, angle: Numbers) -> tuple[Numbers, Numbers]:
    """Two coordinates in axes rotated by an angle [rad] from the first towards the second."""
    xp = namespace(first, second, angle)
    cos, sin = xp.cos(angle), xp.sin(angle)
    # x' = x cos φ + y sin φ,  y' = y cos φ - x sin φ
    return first * cos + second * sin, second * cos - first * sin
