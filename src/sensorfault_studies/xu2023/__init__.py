"""Xu et al. 2023: a follower, two leaders, and faulty ranges."""
