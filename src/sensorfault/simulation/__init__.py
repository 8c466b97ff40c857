"""Simulated drives: true motion and the measurements of realistic sensors."""
