"""Finds the files of a log, and the entry of the vehicle file that describes each."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from sensorfault.core.files import no_input
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.table import LogError
from sensorfault.logs.vehicle import VehicleFile

Where = str | Path | Sequence[str | Path]
VEHICLE = "vehicle.toml"


def files_of(path: Where) -> list[Path]:
    """The files of a log, by name: the one, the several, or the readable ones in the folder.

    Raises:
        LogError: a file is not there, or the folder has no readable file.
    """
    if not isinstance(path, str | Path):
        files = [Path(one) for one in path]
        if not files:
            raise LogError("no file was named; name a file, a folder or several files of one drive.")
    elif Path(path).is_dir():
        from sensorfault.logs.readers.formats import format_of  # lazily: the readers need polars

        inside = _like_logs(Path(path)) + laid_out(Path(path))
        known = ((file, format_of(file)) for file in inside)
        files = sorted({form.leader(file) for file, form in known if form is not None})
        if not files:
            raise LogError(f"{path}: no file in this folder can be read{_drives_in(Path(path))}.")
    else:
        files = [Path(path)]
    for file in files:
        if not file.exists():
            raise LogError(f"{file}: there is no such file or folder; check the path.")
        if reason := no_input(file):
            raise LogError(f"{shown(file)} {reason}; give a log file.")
    return files


# Where the files of known collections lie in the folder of a drive: EuRoC and ASL, KITTI, comma2k19.
_LAYOUTS = ("mav0/*/data.csv", "*/data.csv", "oxts/timestamps.txt", "processed_log/*/*/value", "*/*/value")


def laid_out(folder: Path) -> list[Path]:
    """The files of a drive in subfolders, where these have the names that a known collection gives them."""
    return next((found for layout in _LAYOUTS if (found := sorted(folder.glob(layout)))), [])


def entry_path(file: Path) -> str:
    """What a vehicle.toml calls a file: its name, with its folder's where all files are called alike."""
    return f"{file.parent.name}/{file.name}" if file.name in ALIKE else file.name


def _like_logs(folder: Path) -> list[Path]:
    """The files in a folder whose names are those of logs.

    Raises:
        LogError: there are more than one drive has.
    """
    from sensorfault.logs.readers.registry import pattern

    like_a_log = pattern().fullmatch
    with os.scandir(folder) as entries:
        named = [entry for entry in entries if like_a_log(entry.name.lower())]
    if len(named) > _MOST_FILES:
        raise LogError(f"{folder}: {len(named):,} of its files may be logs; name a folder or the files of one drive.")
    return [folder / entry.name for entry in named if entry.is_file()]


ALIKE = frozenset({"data.csv", "value"})  # names that say nothing: the folder's does


def _drives_in(folder: Path) -> str:
    """What else a folder without a log has."""
    from sensorfault.logs.readers.formats import format_of
    from sensorfault.logs.readers.registry import suffixes

    inside = sorted(one for one in folder.iterdir() if one.is_dir())[:_LOOKED]
    drives = [one.name for one in inside if laid_out(one) or any(map(format_of, filter(Path.is_file, one.iterdir())))]
    if drives:
        return f", but its folders {', '.join(drives[:_SHOWN])} hold logs; name one of them"
    return f"; put one of {', '.join(suffixes())} there"


_LOOKED, _SHOWN = 100, 8  # folders
_MOST_FILES = 2000  # of one drive


def shown(path: Path) -> str:
    """A path as text, whatever bytes its name has."""
    return str(path).encode(errors="surrogateescape").decode(errors="backslashreplace")


@dataclass(frozen=True)
class Found:
    """A vehicle file. `sure`: it was given, or is of this log; else it was written for another one in the folder."""

    vehicle: VehicleFile
    sure: bool = True


def find_vehicle(path: Where, vehicle: str | Path | VehicleFile | None) -> Found | None:
    """The given vehicle file, or the one beside the log, or None.

    Beside `drive.csv` that is `drive.vehicle.toml`, or a `vehicle.toml`.
    """
    if isinstance(vehicle, VehicleFile):
        return Found(vehicle)
    if vehicle is not None:
        return Found(VehicleFile.read(vehicle))
    files = files_of(path)
    own, beside = files[0].with_suffix(f".{VEHICLE}"), files[0].parent / VEHICLE
    if len(files) == 1 and own.is_file():
        return Found(VehicleFile.read(own))
    if not beside.is_file():
        return None
    found = VehicleFile.read(beside)
    if isinstance(path, str | Path) and Path(path).is_dir():
        return Found(found)
    names = {file.name for file in files}
    return Found(found, all(entry.path is None or Path(entry.path).name in names for entry in found.files))


def called_after(vehicle: VehicleFile, path: Where) -> VehicleFile:
    """The description under the log's own name, where it was written for a file of another name."""
    files = files_of(path)
    one = {entry.path for entry in vehicle.files}
    if len(files) > 1 or len(one) > 1 or None in one or Path(str(*one)).name == files[0].name:
        return vehicle
    return replace(vehicle, name=files[0].stem)


def named_after(vehicle: VehicleFile, path: Where) -> VehicleFile:
    """The description under the name of the log's file, or of its folder where it has several."""
    files = files_of(path)
    return replace(vehicle, name=log_name(path, files))


def log_name(path: Where, files: Sequence[Path]) -> str:
    """What a log is called: after its file; after its folder where it has several, or a file in a subfolder."""
    if isinstance(path, str | Path) and Path(path).is_dir() and files[0].parent != Path(path):
        return Path(path).absolute().stem
    return files[0].stem if len(files) == 1 else files[0].absolute().parent.stem


def pair_files(vehicle: VehicleFile, path: Where) -> list[tuple[FileEntry, Path]]:
    """Each described file with the file that it describes.

    Where one file is described and there is one, they belong together whatever its name, so that one vehicle.toml
    serves many drives.

    Raises:
        LogError: a described file is not among those of the log.
    """
    files = files_of(path)
    if len({entry.path for entry in vehicle.files}) == 1 and len(files) == 1:
        return [(_retagged(entry, files[0]), files[0]) for entry in vehicle.files]
    pairs = []
    for entry in vehicle.files:
        if entry.path is None:
            raise LogError(
                f'{vehicle.name}: [file.{entry.name}] has no path, but the log is of several files; write path = "...".'
            )
        called = entry_path(Path(entry.path))
        match = [file for file in files if entry_path(file) == called]
        if not match:
            listed = ", ".join(file.name for file in files)
            raise LogError(
                f"{vehicle.name}: [file.{entry.name}] path = '{entry.path}' is not among {listed}; "
                "name the folder of the log, or correct the path."
            )
        pairs.append((entry, match[0]))
    return pairs


def _retagged(entry: FileEntry, file: Path) -> FileEntry:
    """The entry with the time tag of this file, where it has that of the file that it was written for."""
    if entry.path is None or entry.tag != f"{Path(entry.path).name}.tag":
        return entry
    tag = f"{file.name}.tag"
    return replace(entry, tag=tag if file.with_name(tag).is_file() or file.name == Path(entry.path).name else None)
