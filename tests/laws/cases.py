"""All that must obey the laws: the toy guests, and the catalog.

To put a recipe under the laws, let `recipes` give a Case for it: a monitor fitted on one log, and a few hundred samples
of another one.
"""

import functools

from laws.case import Case
from laws.guests.zoo import zoo


def recipes() -> list[Case]:
    return []


@functools.cache
def cases() -> tuple[Case, ...]:
    return (*zoo(), *recipes())
