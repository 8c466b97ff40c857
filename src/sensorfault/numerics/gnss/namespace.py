"""The array namespace, NumPy or JAX, of some arrays."""

from typing import Any

import numpy as np


def namespace(*arrays: Any) -> Any:
    """JAX's functions if one of these is JAX's, else NumPy's (array API standard, `__array_namespace__`)."""
    found = {array.__array_namespace__() for array in arrays if hasattr(array, "__array_namespace__")} - {np}
    return found.pop() if found else np
