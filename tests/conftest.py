"""What every test may ask for."""

import os
from pathlib import Path

import pytest


def _data() -> Path:
    beside = Path(__file__).parents[2] / "shared" / "data"
    return Path(os.environ.get("SENSORFAULT_DATA", beside))


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of real logs; a test that asks for it is skipped where there is none."""
    folder = _data()
    if not folder.is_dir():
        pytest.skip(f"needs the real logs: set SENSORFAULT_DATA to their folder ({folder} is not there)")
    return folder
