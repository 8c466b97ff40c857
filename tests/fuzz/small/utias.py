"""UTIAS's text, written by hand after its document."""

from fuzz.writing import EPOCHS, text_file


def utias() -> str:
    """Two barcodes seen at once."""
    rows = [
        f"{1248444189 + k}.599 \t  {one} \t  {3 + 0.1 * k:.3f} \t -0.257\n" for k in range(EPOCHS) for one in (14, 90)
    ]
    head = "# UTIAS Multi-Robot Cooperative Localization and Mapping Dataset\n# Measurement Data Format:\n"
    return f"{head}# Time [s]    Subject #    range [m]    bearing [rad]\n{''.join(rows)}"


SMALL = {"UTIAS measurements": text_file("Robot1_Measurement.dat", utias)}
