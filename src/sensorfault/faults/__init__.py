"""Faults injected into logs: what a sensor does wrong, when and how much."""
