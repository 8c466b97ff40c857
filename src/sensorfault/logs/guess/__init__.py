"""Guess: what the columns of an unknown log are."""

from sensorfault.logs.guess.vehicle import guess

__all__ = ["guess"]
