"""RTKLIB's solutions, written by hand after its document."""

from fuzz.writing import EPOCHS, text_file


def pos() -> str:
    """RTKLIB's solutions."""
    rows = [
        f"2025/08/24 12:00:{k:02}.250  48.{1000000 + 13 * k:07}  11.6000000  512.{300 + k} 1 12  0.01 0.01 0.02\n"
        for k in range(EPOCHS)
    ]
    return "% GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m)\n" + "".join(rows)


SMALL = {"RTKLIB solution": text_file("rover.pos", pos)}
