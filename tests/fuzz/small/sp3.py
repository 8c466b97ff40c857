"""SP3, written by hand after its document."""

from fuzz.writing import EPOCHS, text_file


def sp3() -> str:
    """A dozen epochs of two satellites."""
    rows = [
        f"*  2025  8 24 12 {5 * k:2}  0.00000000\n"
        f"PG07{14567.933924 + k:14.6f}{2809.850969 - k:14.6f}{21875.628068:14.6f}{123.456789:14.6f}\n"
        f"PE30{-5941.116736:14.6f}{-9510.788701:14.6f}{22950.281256 + k:14.6f}{999999.999999:14.6f}\n"
        for k in range(EPOCHS)
    ]
    return "#dP2025  8 24 12  0  0.00000000      12   u+U IGS20 FIT  XXX\n" + "".join(rows) + "EOF\n"


SMALL = {"SP3 orbits": text_file("day.sp3", sp3)}
