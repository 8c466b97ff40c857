"""Constants of the interface documents."""

LIGHT_M_S = 299_792_458.0  # c
EARTH_RATE_RAD_S = 7.292_115_146_7e-5  # Ω̇e of WGS-84 (IS-GPS-200, table 20-IV)
EARTH_RATE = {  # of each system's orbits; GPS's rate for BeiDou gives an error of 24 m at the end of a week
    "G": EARTH_RATE_RAD_S,
    "J": EARTH_RATE_RAD_S,
    "E": EARTH_RATE_RAD_S,  # OS SIS ICD, table 68
    "C": 7.292_115_0e-5,  # BDS-SIS-ICD-B1I, table 5-11
}
EARTH_MU = {  # gravitational constant times the mass of the earth, as each system's document has it [m³/s²]
    "G": 3.986_005e14,  # GPS: IS-GPS-200, table 20-IV
    "J": 3.986_005e14,  # QZSS
    "E": 3.986_004_418e14,  # Galileo: OS SIS ICD, table 68
    "C": 3.986_004_418e14,  # BeiDou: BDS-SIS-ICD-B1I, table 5-11
}
L1_HZ = 1_575.42e6
"""The frequency that GPS and Galileo share; Klobuchar's delay is for this frequency."""
B3I_HZ = 1_268.52e6
"""BeiDou's frequency, to which its satellite clocks refer (BDS-SIS-ICD-B1I, 5.2.4.10)."""
WEEK_S = 604_800.0
