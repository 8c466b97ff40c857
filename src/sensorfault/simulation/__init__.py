"""Drives that never happened: true motion and what real sensors would have said about it."""
