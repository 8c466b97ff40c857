"""What every test may ask for."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from haste import optimised


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """A worker takes a file as a whole, so that what a file fits is fitted once; of the laws it takes a case.

    The tests of a group follow each other in one process, too, so that no more than one case is kept in memory.
    """
    groups = {item: _group(item) for item in items}
    order = {group: place for place, group in enumerate(dict.fromkeys(groups.values()))}
    items.sort(key=lambda item: order[groups[item]])
    for item, group in groups.items():
        item.add_marker(pytest.mark.xdist_group(group))


def _group(item: pytest.Item) -> str:
    given = getattr(item, "callspec", None)
    case = given.params.get("case") if given else None
    law = item.path.name == "test_laws.py" and isinstance(case, str)
    return f"laws of {case}" if law else str(item.path)


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
