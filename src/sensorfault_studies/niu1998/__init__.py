"""Niu & Zhao 1998: sensors of a robot arm, monitored by a network that learns online."""
