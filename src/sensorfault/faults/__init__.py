"""Faults put into logs on purpose: what a sensor does wrong, when and how much."""
