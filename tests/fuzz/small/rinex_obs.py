"""RINEX observations, written by hand after its document."""

from fuzz.rinex_header import header
from fuzz.writing import EPOCHS, text_file


def rinex_3() -> str:
    """Version 3: GPS and Galileo."""
    head = (
        header("     3.04           OBSERVATION DATA    M: Mixed", "RINEX VERSION / TYPE")
        + header("G    3 C1C D1C S1C", "SYS / # / OBS TYPES")
        + header("E    4 C1X L1X D1X S1X", "SYS / # / OBS TYPES")
        + header("  2025     8    24    12     0    0.0000000     GPS", "TIME OF FIRST OBS")
        + header("", "END OF HEADER")
    )
    rows = [
        f"> 2025  8 24 12  0 {k:2}.0000000  0  3\n"
        f"G07{2.1e7 + k:14.3f} 1{-500.25:14.3f}  {44.0:14.3f}  \n"
        f"G12{2.2e7 + k:14.3f} 1{100.5:14.3f}  {40.0:14.3f}  \n"
        f"E30{2.3e7 + k:14.3f} 1{'':16}{1234.5:14.3f}  {38.0:14.3f}  \n"
        for k in range(EPOCHS)
    ]
    return head + "".join(rows)


def rinex_2() -> str:
    """Version 2: six kinds of observation, so that a satellite has two lines."""
    head = (
        header("     2.11           OBSERVATION DATA    M (MIXED)", "RINEX VERSION / TYPE")
        + header("     6    C1    L1    L2    P2    D1    S1", "# / TYPES OF OBSERV")
        + header("", "END OF HEADER")
    )
    rows = [
        f" 25  8 24 12  0 {k:2}.0000000  0  2G07R 1\n"
        + "".join(f"{2e7 + i + k:14.3f} 5{'':48}{-10.5 * i:14.3f}  \n{41.0:14.3f}  \n" for i in (1, 2))
        for k in range(EPOCHS)
    ]
    return head + "".join(rows)


SMALL = {
    "RINEX observations": text_file("site.obs", rinex_3),
    "RINEX observations, version 2": text_file("site.25o", rinex_2),
}
