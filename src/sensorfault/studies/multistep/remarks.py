"""placeholder"""


def remarks(told: object) -> tuple[str, ...]:
    """None yet."""
    return ()
