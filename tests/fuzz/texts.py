"""Small sound files of the text formats, written by hand after their documents."""

EPOCHS = 12


def _header(text: str, label: str) -> str:
    return f"{text:60}{label}\n"


def pos() -> str:
    """RTKLIB's solutions."""
    rows = [
        f"2025/08/24 12:00:{k:02}.250  48.{1000000 + 13 * k:07}  11.6000000  512.{300 + k} 1 12  0.01 0.01 0.02\n"
        for k in range(EPOCHS)
    ]
    return "% GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m)\n" + "".join(rows)


def librsf() -> str:
    """Two satellites and an odometer."""
    rows = []
    for k in range(EPOCHS):
        rows.append(f"odom3 {0.2 * k:.14g} {5 + 0.1 * k} 0 0 0 0 {-0.01 * k} 1 1 1 1 1 1\n")
        rows += [
            f"pseudorange3 {0.2 * k:.14g} {2e7 + 10 * k} 25 1.4e7 {2.8e6 + k} 2.2e7 {number} {system} 45.5 40\n"
            for number, system in ((12, 1), (320, 4))
        ]
    return "".join(rows)


def smartloc() -> str:
    """Two satellites with their labels."""
    names = (
        "GPSWeek [weeks];GPSSecondsOfWeek [s];Longitude (GT Lon) [deg];Latitude (GT Lat) [deg];"
        "Height above ellipsoid (GT Height) [m];Velocity (GT Velocity) [m/s];Measurement time of week (rcvTow) [s];"
        "GPS week number (week) [weeks];Pseudorange measurement (prMes) [m];Doppler measurement (doMes) [Hz];"
        "GNSS identifier (gnssId) [];Satellite identifier (svId) [];Carrier-to-noise density ratio (cno) [dbHz];"
        "Estimated pseudorange measurement standard deviation (prStdev) [m];NLOS (0 == no, 1 == yes)\n"
    )
    rows = [
        f"1900;{1000 + k};13.37;{52.5 + 1e-5 * k};76.0;{5 + k};{1000 + k};1900;{2e7 + k};{-500 - k};{system};{number};"
        f"40;0.32;{k % 2}\n"
        for k in range(EPOCHS)
        for system, number in (("GPS", 12), ("Glonass", 20))
    ]
    return names + "".join(rows)


def utias() -> str:
    """Two barcodes seen at once."""
    rows = [
        f"{1248444189 + k}.599 \t  {one} \t  {3 + 0.1 * k:.3f} \t -0.257\n" for k in range(EPOCHS) for one in (14, 90)
    ]
    head = "# UTIAS Multi-Robot Cooperative Localization and Mapping Dataset\n# Measurement Data Format:\n"
    return f"{head}# Time [s]    Subject #    range [m]    bearing [rad]\n{''.join(rows)}"


def rinex_3() -> str:
    """Version 3: GPS and Galileo."""
    head = (
        _header("     3.04           OBSERVATION DATA    M: Mixed", "RINEX VERSION / TYPE")
        + _header("G    3 C1C D1C S1C", "SYS / # / OBS TYPES")
        + _header("E    4 C1X L1X D1X S1X", "SYS / # / OBS TYPES")
        + _header("  2025     8    24    12     0    0.0000000     GPS", "TIME OF FIRST OBS")
        + _header("", "END OF HEADER")
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
        _header("     2.11           OBSERVATION DATA    M (MIXED)", "RINEX VERSION / TYPE")
        + _header("     6    C1    L1    L2    P2    D1    S1", "# / TYPES OF OBSERV")
        + _header("", "END OF HEADER")
    )
    rows = [
        f" 25  8 24 12  0 {k:2}.0000000  0  2G07R 1\n"
        + "".join(f"{2e7 + i + k:14.3f} 5{'':48}{-10.5 * i:14.3f}  \n{41.0:14.3f}  \n" for i in (1, 2))
        for k in range(EPOCHS)
    ]
    return head + "".join(rows)


def navigation() -> str:
    """Version 3: two hours of one GPS satellite and a quarter of an hour of one of GLONASS."""
    head = (
        _header("     3.04           N: GNSS NAV DATA    M: Mixed", "RINEX VERSION / TYPE")
        + _header("GPSA   1.4901E-08  2.2352E-08 -1.1921E-07 -1.1921E-07", "IONOSPHERIC CORR")
        + _header("GPSB   1.1469E+05  1.6384E+05 -6.5536E+04 -4.5875E+05", "IONOSPHERIC CORR")
        + _header("", "END OF HEADER")
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


def sp3() -> str:
    """A dozen epochs of two satellites."""
    rows = [
        f"*  2025  8 24 12 {5 * k:2}  0.00000000\n"
        f"PG07{14567.933924 + k:14.6f}{2809.850969 - k:14.6f}{21875.628068:14.6f}{123.456789:14.6f}\n"
        f"PE30{-5941.116736:14.6f}{-9510.788701:14.6f}{22950.281256 + k:14.6f}{999999.999999:14.6f}\n"
        for k in range(EPOCHS)
    ]
    return "#dP2025  8 24 12  0  0.00000000      12   u+U IGS20 FIT  XXX\n" + "".join(rows) + "EOF\n"
