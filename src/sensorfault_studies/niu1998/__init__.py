"""Niu & Zhao 1998: sensors of a robot arm, watched by a network that learns while it watches."""
