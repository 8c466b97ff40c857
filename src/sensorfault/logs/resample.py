"""How the values of a slow file come to the ticks of the fastest one."""

from typing import Literal

# "hold": each measurement on the first tick at or after its time; "linear": drawn between measurements.
Resample = Literal["hold", "linear"]
