"""smartLoc's text, written by hand after its document."""

from fuzz.writing import EPOCHS, text_file


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


SMALL = {"smartLoc measurements": text_file("RXM-RAWX.csv", smartloc)}
