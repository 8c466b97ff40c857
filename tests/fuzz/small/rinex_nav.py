"""RINEX navigation, written by hand after its document."""

from fuzz.rinex_header import header
from fuzz.writing import text_file


def navigation() -> str:
    """Version 3: two hours of one GPS satellite and a quarter of an hour of one of GLONASS."""
    head = (
        header("     3.04           N: GNSS NAV DATA    M: Mixed", "RINEX VERSION / TYPE")
        + header("GPSA   1.4901E-08  2.2352E-08 -1.1921E-07 -1.1921E-07", "IONOSPHERIC CORR")
        + header("GPSB   1.1469E+05  1.6384E+05 -6.5536E+04 -4.5875E+05", "IONOSPHERIC CORR")
        + header("", "END OF HEADER")
    )

    def record(first: str, numbers: list[float]) -> str:
        cells = [f"{number:19.12e}" for number in numbers]
        lines = ["    " + "".join(cells[i : i + 4]) + "\n" for i in range(3, len(cells), 4)]
        return first + "".join(cells[:3]) + "\n" + "".join(lines)

    records = []
    turn = 7200 * (3.986005e14 / 5153.7**6) ** 0.5  # of the mean anomaly in two hours
    for k in range(3):  # week 2381 begins on 2025-08-24
        orbit = [1e-4, 1e-12, 0, 55, 10, 0, 0.5 + turn * k, 1e-6, 0.01, 8e-6, 5153.7]
        orbit += [
            43200 + 7200 * k,
            1e-8,
            -2.1,
            2e-8,
            0.96,
            250,
            0.7,
            0,
            1e-10,
            1,
            2381,
            0,
            2,
            0,
            -1e-9,
            55,
            43200,
            4,
        ]
        records.append(record(f"G07 2025 08 24 {12 + 2 * k:02} 00 00", orbit))
    state = [-1e-4, 0, 3e5, 10541.1572266, 0.321145, 0, 0, 363.174, 3.16727, 0, -3, 23234.1108, -0.19101, 0, 0]
    return head + "".join(records) + record("R18 2025 08 24 12 15 00", state)


SMALL = {"RINEX navigation": text_file("site.nav", navigation)}
