"""What every test may ask for."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from xdist.remote import Producer
from xdist.scheduler import LoadScopeScheduling

from haste import optimised


class ByFile(LoadScopeScheduling):
    """A worker takes a file as a whole, so that what a file fits is fitted once; of the laws it takes a case.

    (`--dist loadgroup` of pytest-xdist 3.8 splits groups without a word under pytest 9.2.)
    """

    def _split_scope(self, nodeid: str) -> str:
        file, _, test = nodeid.partition("::")
        case = test.rstrip("]").partition("[")[2]
        if not file.endswith("test_laws.py") or not case:
            return file
        from laws.register import CASES  # later than the hook that checks types of what is imported

        return "laws of " + max((name for name in CASES if case.endswith(name)), key=len, default=case)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> ByFile:
    return ByFile(config, log)


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
