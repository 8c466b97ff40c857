"""The toy guests, which are in no catalog."""

from laws.guests.motion import moving
from laws.guests.zoo import zoo

ZOO = {case.name: case for case in (*zoo(), moving())}
CASES = {name: lambda case=case: case for name, case in ZOO.items()}
HAVE = {
    field: tuple(name for name, case in ZOO.items() if getattr(case, field))
    for field in ("permuted", "block", "rate", "moving")
}
