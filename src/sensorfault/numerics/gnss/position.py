"""What a position needs."""

LEAST = 4  # satellites
