"""A line of a RINEX header."""


def header(text: str, label: str) -> str:
    """The label stands behind column 60."""
    return f"{text:60}{label}\n"
