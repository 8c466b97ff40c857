"""What every test may ask for."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from haste import optimised


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


@pytest.fixture
def hasty(request: pytest.FixtureRequest) -> Iterator[None]:
    """For tests on short logs; those on real logs among them stay as they are."""
    with optimised(request.node.get_closest_marker("real") is not None):
        yield
