"""Simulated drives and flights with one fault each, made after public reports, that stand beside the real logs."""

import json
import shutil
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from sensorfault.events.event import Event
from sensorfault.logs import read
from sensorfault.runtime.compared import Comparison, NothingToCompare, compare, comparison_of

pytestmark = pytest.mark.real

LATE_S, EARLY_S = 12.0, 2.0
TWO_WITNESSES = {"gps_pulled_2ms.csv", "gnss_600ms_late.csv"}  # no third one can say which of two is wrong


@pytest.fixture(scope="module")
def cases(real_data: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files without their descriptions, which would say what the columns are."""
    folder = real_data.parent / "cases" / "faults"
    if not folder.is_dir():
        pytest.skip(f"needs the cases of faults beside the real logs ({folder} is not there)")
    bare: Path = tmp_path_factory.mktemp("faults")
    (bare / "healthy").mkdir()
    for file in [*folder.rglob("*.csv"), folder / "truth.json"]:
        shutil.copy(file, bare / file.relative_to(folder))
    return bare


@cache
def fitted(path: Path) -> Comparison | None:
    try:
        return comparison_of(read(path))
    except NothingToCompare:
        return None


def right(event: Event, case: dict[str, Any]) -> bool:
    sensor = case["sensor"].strip("()")
    named = event.sensor == sensor or (
        case["file"] in TWO_WITNESSES and not event.sensor and sensor in event.candidates
    )
    return named and case["start_s"] - EARLY_S <= event.start_s <= case["end_s"] + LATE_S


@pytest.mark.parametrize(("fit", "least"), [(False, 15), (True, 19)])
def test_faults_are_named_and_no_innocent_is(cases: Path, fit: bool, least: int) -> None:
    found, wrong = [], []
    for case in json.loads((cases / "truth.json").read_text()):
        model = fitted(cases / "healthy" / case["healthy_run"]) if fit else None
        events = compare(read(cases / case["file"]), model).events
        if case["healthy"]:
            wrong += [(case["file"], str(event)) for event in events]
            continue
        found += [case["file"]] if any(right(event, case) for event in events) else []
        innocent = (event for event in events if event.sensor not in (None, case["sensor"].strip("()")))
        wrong += [(case["file"], str(event)) for event in innocent]
    assert wrong == []
    assert len(found) >= least, found
