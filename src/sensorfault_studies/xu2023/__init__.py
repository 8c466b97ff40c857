"""Xu et al. 2023 reproduced: a follower, two leaders, and ranges that lie."""
