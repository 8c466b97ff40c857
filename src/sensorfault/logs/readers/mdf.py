"""ASAM MDF measurement files (`.mf4`, `.mdf`): each channel group is a table with its own clock."""

from pathlib import Path

import polars as pl

from sensorfault.core.extras import require
from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.handing import Handing
from sensorfault.logs.readers.mdf_load import TIME
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, with_notes
from sensorfault.logs.readers.subprocess_reader import Loaded, load_apart
from sensorfault.logs.table import LogError
from sensorfault.logs.units import known, spelled

_NOTHING = Loaded({}, {"lost": []})


def read_mdf(path: Path, ask: Ask) -> Tables:
    """Every channel group with two rows or more and numbers in it, on Unix time. A group that is damaged is left out.

    Raises:
        LogError: no MDF file, or no such group in it.
        MissingLibrary: asammdf is not installed.
    """
    require(f"{path}: reading it", "asammdf")
    handing = Handing(ask)
    try:
        loaded = load_apart("mdf_load", path, 0 if handing.asked else None)
    except ValueError as error:
        raise LogError(f"{path}: not a whole MDF file ({error}); export it again.") from None
    if loaded.result["frames"]:
        raise LogError(
            f"{path}: it holds frames of a CAN bus, and no .dbc file beside it describes them; put one there."
        )
    damage, others = _lost(loaded), loaded.result["others"]
    parts = loaded.result["parts"] if handing.asked else 1
    for part in range(1, parts):
        handing.on(_tables(path, ask, loaded))
        ask.tell(part / parts)
        try:
            loaded = load_apart("mdf_load", path, part)
        except ValueError as error:
            damage.append(Damage(f"the file cannot be read further ({error})", f"part {part + 1} of {parts}"))
            loaded = _NOTHING
            break
        damage += _lost(loaded)
        others = max(others, loaded.result["others"])
    tables = handing.rest(_tables(path, ask, loaded))
    if not tables and ask.tables is None:
        raise LogError(f"{path}: no channel group with a clock and numbers in this MDF file; export it again.")
    said = [f"{path.name}: {counted(others, 'channel')} of texts or arrays left out."] if others else []
    return with_notes(tables, said, dict.fromkeys(damage))


def _lost(loaded: Loaded) -> list[Damage]:
    return [
        Damage(f"a channel group cannot be read ({why})", f"'{name}'", "the others were read")
        for name, why in loaded.result["lost"]
    ]


def _tables(path: Path, ask: Ask, loaded: Loaded) -> Tables:
    tables = {}
    for name, columns in loaded.vectors.items():
        if ask.wants(name):
            written = loaded.result["units"][name].items()
            units = {column: spelled(unit) for column, unit in written if known(unit)}
            tables[name] = Source(path, pl.DataFrame(columns), TIME, "s", units=units)
    return tables


def looks_mdf(head: bytes) -> bool:
    """Whether a file that begins so is one."""
    return head.startswith((b"MDF ", b"UnFinMF "))


FORMAT = Format("MDF", ("*.mf4", "*.mdf", "*.dat"), remembering(read_mdf), looks_mdf, parts=True)
