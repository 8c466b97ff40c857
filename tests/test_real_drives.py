"""The main job on real drives: fit paper A's autoencoder on the first 60 %, lie in the rest, find out.

What the methods of this version do not see is written down here too: 20 of its own sigmas stay within the healthy range
of a channel that is calm for most of a drive and shaken now and then (the pitch rate of both drives, the vertical
acceleration of Dresden's), so offsets on those are counted but not asked for.
"""

import json
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from sensorfault.cli import main
from sensorfault.evaluation.judge import Outcome, judge
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.faults.plan import plan
from sensorfault.logs import read
from sensorfault.logs.table import Log
from sensorfault.methods.fit import fit
from sensorfault.runtime.detect import detect
from sensorfault.runtime.fault_tracker import QUIET_S
from sensorfault.runtime.model import Model
from sensorfault.runtime.result import Detection

pytestmark = pytest.mark.real

LEARN = 0.6
AT_ONCE = 6  # faults in one copy of the rest, with five healthy seconds between any two
DRIVES = ("dresden_50hz", "gnss_imu_drive0708")
IMU = tuple((sensor, axis) for sensor in ("gyro", "accelerometer") for axis in "xyz")
FAINT = {"dresden_50hz": {("gyro", "y"), ("accelerometer", "z")}, "gnss_imu_drive0708": {("gyro", "y")}}
AS_PUBLISHED = "elm-autoencoder"
# Of the untouched rest, measured 2026-11-24: Dresden 0 in 1.4 min. Drive 0708 with the published limit 4 to 6 in 3.7
# min: moments of half a second, rougher than any in the part fitted on. With the cross-validated one 3, 1, 0, 0, 2 for
# the seeds 0 to 4: what a network of random weights makes of them is chance. The default, judged against the roughness
# of the last half second, says nothing. So few say little about a rate; the bound keeps it from growing unnoticed.
ALARMS_AN_HOUR = {
    ("dresden_50hz", AS_PUBLISHED): 0.0,
    ("gnss_imu_drive0708", AS_PUBLISHED): 100.0,
    ("dresden_50hz", "elm-cross-validated"): 0.0,
    ("gnss_imu_drive0708", "elm-cross-validated"): 100.0,
    ("dresden_50hz", "relative-conditioning"): 0.0,
    ("gnss_imu_drive0708", "relative-conditioning"): 0.0,
}


@dataclass(frozen=True)
class Drive:
    model: Model
    rest: Log
    clean: Detection


@cache
def drive(folder: Path, method: str = AS_PUBLISHED) -> Drive:
    log = read(folder)
    cut = float(log.time[0]) + LEARN * log.duration_s
    model = fit(log.between(end_s=cut), method, held_out=0.0)
    return Drive(model, log.between(cut), detect(model, log.between(cut)))


def lies(known: Drive, wanted: list[Fault], seed: int) -> tuple[list[Outcome], list[Detection]]:
    """Each fault is struck in a copy of the rest with a few others; judged is what is told of each."""
    outcomes, found = [], []
    for n in range(0, len(wanted), AT_ONCE):
        faults = plan(known.rest, wanted[n : n + AT_ONCE], pause_s=5.0, seed=seed + n)
        injected = inject(known.rest, faults, seed)
        found.append(detect(known.model, injected.log))
        outcomes += judge(found[-1], injected.truth).outcomes
    return outcomes, found


def in_an_alarm(known: Drive, outcome: Outcome) -> bool:
    """Whether the untouched drive raises an alarm there itself, which would go on into the fault and not count."""
    near = [(event.start_s - QUIET_S, (event.end_s or event.start_s) + QUIET_S) for event in known.clean.events]
    return any(first <= outcome.fault.end_s and outcome.fault.start_s <= last for first, last in near)


def result(outcome: Outcome) -> str:
    fault, named = outcome.fault, outcome.named
    said = "nothing" if named is None else f"{named.kind} on {named.sensor}.{named.channel}"
    return f"{fault.kind} on {fault.where} at {fault.start_s:.2f} s: {said}"


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("name", DRIVES)
def test_shorts_and_offsets_are_found_and_named(name: str, seed: int, real_data: Path) -> None:
    known = drive(real_data / "road" / name)
    wanted = [Fault("spike", *where, 0.0, 0.0, 20.0, sigmas=True) for where in IMU]
    wanted += [Fault("offset", *where, 0.0, 4.0, 20.0, sigmas=True) for where in IMU]
    outcomes, _ = lies(known, wanted, seed)
    right = {result(o): o.sensor_right and o.channel_right and o.kind_right for o in outcomes}
    print(f"{name}: {sum(right.values())} of {len(right)} offsets found and named; not:")
    print(*(f"  {words}" for words, ok in right.items() if not ok), sep="\n")
    asked = [o for o in outcomes if (o.fault.sensor, o.fault.channel) not in FAINT[name] and not in_an_alarm(known, o)]
    assert len(asked) >= 7
    assert [result(o) for o in asked if not right[result(o)]] == []
    assert max(o.delay_s for o in asked) <= 0.5


@pytest.mark.parametrize("name", DRIVES)
def test_jams_are_found_and_named(name: str, real_data: Path) -> None:
    known = drive(real_data / "road" / name)
    outcomes, found = lies(known, [Fault("frozen", *where, 0.0, 4.0) for where in IMU], 0)
    wrong = [result(o) for o in outcomes if not (o.sensor_right and o.channel_right and o.kind_right)]
    assert not wrong
    assert max(o.delay_s for o in outcomes) <= 0.5
    jams = {(event.sensor, event.channel) for one in found for event in one.events if event.kind == "frozen"}
    assert jams == set(IMU)


@pytest.mark.parametrize("name", DRIVES)
def test_silences_are_found_and_named(name: str, real_data: Path) -> None:
    known = drive(real_data / "road" / name)
    outcomes, _ = lies(
        known, [Fault("missing", sensor, None, 0.0, 3.0) for sensor in ("gyro", "gnss", "accelerometer")], 0
    )
    wrong = [result(o) for o in outcomes if not (o.sensor_right and o.channel_right and o.kind_right)]
    assert not wrong
    period = {sensor.name: sensor.period_s for sensor in known.model.sensors}
    assert all(o.delay_s <= 5 * period[o.fault.sensor] for o in outcomes)


@pytest.mark.parametrize(("name", "method"), ALARMS_AN_HOUR)
def test_false_alarms_on_the_untouched_rest(name: str, method: str, real_data: Path) -> None:
    known = drive(real_data / "road" / name, method)
    hours = known.rest.duration_s / 3600
    # The IMU of drive 0708 outlives the last fix by 2.8 s: that silence is so.
    alarms = [event for event in known.clean.events if event.kind != "missing" or event.end_s is not None]
    print(f"{name}, {method}: {len(alarms)} false alarms in {60 * hours:.1f} min, {len(alarms) / hours:.0f} an hour")
    assert len(alarms) / hours <= ALARMS_AN_HOUR[name, method]


def test_held_fixes_are_never_a_jam(real_data: Path) -> None:
    """Dresden's log repeats four of five fixes, and a parked car repeats them for longer."""
    folder = real_data / "road" / "dresden_50hz"
    known, log = drive(folder), read(folder)
    held = {sensor.name for sensor in log.sensors if sensor.held}
    assert any("gnss" in name for name in held)
    for part in (log, known.rest):  # the part fitted on, too
        events = detect(known.model, part).events
        assert not [event for event in events if event.sensor in held and event.kind != "missing"]


def test_the_command_line_names_an_offset_and_nobody_else(
    real_data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """By conditioning, which sees it come and go: what lasts between is the channel's own word again."""
    folder = real_data / "road" / "dresden_50hz"
    known = drive(folder)
    cut = float(known.rest.time[0])

    def run(*words: str) -> str:
        monkeypatch.setattr(sys, "argv", ["sensorfault", *words])
        main()
        return capsys.readouterr().out

    model, faulty = str(tmp_path / "car.sensorfault"), str(tmp_path / "faulty.csv")
    method = "--method", "relative-conditioning"
    run("fit", str(folder), *method, "--until", f"{cut - 1e-3:.6f}", "--held-out", "0", "--out", model)
    start = round(cut) + 20
    run("inject", str(folder), "--fault", f"offset:gyro.z:{start}:5:20sigma", "--out", faulty)
    events = json.loads(run("detect", faulty, "--model", model, "--json", "-"))["events"]
    late = [event for event in events if event["start_s"] >= cut]
    assert [(event["sensor"], event["channel"], event["kind"]) for event in late] == [("gyro", "z", "offset")] * 2
    assert [event["start_s"] for event in late] == pytest.approx([start, start + 5], abs=0.1)
