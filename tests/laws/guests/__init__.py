"""Toy stages that are in no paper: what the monitor must be able to carry, as small as it can be."""
