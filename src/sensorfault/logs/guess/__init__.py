"""Guess: what the columns of an unknown log are."""

from sensorfault.logs.guess.vehicle import guess, guess_source

__all__ = ["guess", "guess_source"]
