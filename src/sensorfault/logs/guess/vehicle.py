"""Describe an unknown log: which columns are which sensor, in what unit, held or new. Every guess gives its reason."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from sensorfault.logs.guess.columns import OTHER_TIME, QUALITY
from sensorfault.logs.guess.exported import topics_of
from sensorfault.logs.guess.look import Guess, guess_table, look_at, look_at_topics
from sensorfault.logs.guess.naming import joined, short_names, stem_of
from sensorfault.logs.place import Where, files_of, log_name
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError
from sensorfault.logs.vehicle import VehicleFile, with_rate

_RAW = "_uncalibrated"


@np.errstate(over="ignore", invalid="ignore")  # of numbers as damage makes them
def guess_files(path: Where, tell: Callable[[float], None], rate_hz: float | None = None) -> VehicleFile:
    """Does the work of `guess`."""
    files = files_of(path)
    topics = topics_of(files)
    others = [file.name for file in files if file not in topics.values()]
    looked = [look_at_topics(topics, others, tell)] if topics else [look_at(file, tell, rate_hz) for file in files]
    guesses = [one for look in looked for one in look.guesses]
    errors = [error for look in looked for error in look.errors]
    if not guesses:
        raise (
            errors[0]
            if len(errors) == 1
            else LogError(f"{path}: none of its {len(errors)} files or tables can be used; the first: {errors[0]}")
        )
    notes = [*(note for look in looked for note in look.notes), *(f"Left out: {error}" for error in errors)]
    if not topics:
        _refuse_several_drives(guesses)
    guesses, raw = _calibrated(guesses)
    guesses.sort(key=_order)
    names = (
        ["log"] if len(guesses) == 1 else short_names([(one.stem, one.path.name, one.file.table) for one in guesses])
    )
    taken = [sensor.name for one in guesses for sensor in one.sensors]
    sensors = [
        replace(sensor, file=name, name=sensor.name if taken.count(sensor.name) == 1 else joined(name, sensor.name))
        for one, name in zip(guesses, names, strict=True)
        for sensor in one.sensors
    ]
    entries = [replace(one.file, name=name) for one, name in zip(guesses, names, strict=True)]
    name = stem_of(files[0]) if len(files) == 1 and files[0] == path else log_name(path, files)
    said = (*notes, *raw, *_untied(guesses), *_missed(guesses))
    found = VehicleFile(name, tuple(entries), tuple(sensors), notes=said, where="a guess", guessed=True)
    return found if rate_hz is None else with_rate(found, rate_hz)


@np.errstate(over="ignore", invalid="ignore")
def guess_source(source: Source, rate_hz: float | None = None) -> VehicleFile:
    """Describe one table from its names and values.

    Raises:
        LogError: no column rises like a time, or none measures anything.
    """
    one = guess_table(source, None, rate_hz)
    file = replace(one.file, name="log")
    said = tuple(_missed([one]))
    return VehicleFile(source.path.stem, (file,), tuple(one.sensors), notes=said, where="a guess", guessed=True)


def _refuse_several_drives(guesses: list[Guess]) -> None:
    """Files with the same columns are one log only if their clocks say so: by the time of day, or by being one."""
    for i, one in enumerate(guesses):
        for other in guesses[:i]:
            start = max(one.clock.zero_s, other.clock.zero_s)
            end = min(guess.clock.zero_s + float(guess.clock.time[-1]) for guess in (one, other))
            together = one.clock.is_unix and other.clock.is_unix and start < end
            together |= one.times is not None and one.times == other.times
            if one.columns == other.columns and one.path != other.path and not together:
                raise LogError(
                    f"{one.path.parent}: {other.path.name} and {one.path.name} have the same columns and look like two "
                    "drives; name the files of one drive."
                )


def _calibrated(guesses: list[Guess]) -> tuple[list[Guess], list[str]]:
    """The files without those that hold the raw readings of another: a device must not confirm itself."""
    known = {one.stem for one in guesses}
    raw = [one for one in guesses if one.stem.removesuffix(_RAW) in known - {one.stem}]
    notes = [f"{one.path.name}: left out: uncalibrated readings of a sensor in another file." for one in raw]
    return [one for one in guesses if one not in raw], notes


def _order(one: Guess) -> tuple[bool, int]:
    """Measurements first, and of them fast files: where several say the same, the first is the best.

    Rates within an octave are alike.
    """
    return not one.measures, round(math.log2(one.clock.period_s))


def _missed(guesses: list[Guess]) -> list[str]:
    """A sentence for each file with columns left out that a person might look for."""
    said = []
    for one in guesses:
        out = [f"{name} ({reason})" for name, reason in one.file.left_out if reason not in (OTHER_TIME, QUALITY)]
        if one.file.doubt:
            said.append(f"{one.called}: {one.file.doubt}; the unit of the time in vehicle.toml says which is right.")
        if out:
            said.append(f"{one.called}: columns left out, as they are not measurements: {', '.join(out)}.")
    return said


def _untied(guesses: list[Guess]) -> list[str]:
    """A sentence for each file whose clock has nothing to do with the others'."""
    tied = [one for one in guesses if one.clock.is_unix or one.file.tag]
    return [
        f"{one.path.name}: its clock is not Unix time like those of the other files; set offset_s in vehicle.toml."
        for one in guesses
        if tied and one not in tied
    ]
