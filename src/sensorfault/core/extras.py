"""Libraries that only some users need: which extra installs each, and the sentence where one is missing."""

from importlib.util import find_spec

# Every library that the core installation does not bring, by the name it is imported under.
EXTRA_OF = {
    "asammdf": "bus",
    "can": "bus",
    "cantools": "bus",
    "foxglove": "viewers",
    "google": "logs",  # protobuf
    "h5py": "matlab",
    "mcap": "logs",
    "plotly": "plot",
    "polars": "tables",
    "pymavlink": "logs",
    "pynmeagps": "logs",
    "pyulog": "logs",
    "rosbags": "logs",
    "zstandard": "logs",
}


class MissingLibrary(ImportError):
    """A library of an extra is not installed. One sentence: what needs it, and the command that installs it."""


def require(what: str, *libraries: str) -> None:
    """Check before the work that libraries are there.

    Args:
        what: what needs them; the sentence begins with it: `a report page`.
        libraries: the names they are imported under, as in EXTRA_OF.

    Raises:
        MissingLibrary: at least one is not installed.
    """
    missing = [library for library in libraries if not _installed(library)]
    if missing:
        raise MissingLibrary(_sentence(what, missing), name=missing[0])


def sentence_of_missing(error: ImportError, what: str) -> str | None:
    """The sentence for an import that failed because an extra is not installed; None if it failed for another reason.

    Args:
        error: what the import raised.
        what: what needs the library; the sentence begins with it.
    """
    if isinstance(error, MissingLibrary):
        return str(error)
    library = (error.name or "").partition(".")[0]
    return _sentence(what, [library]) if library in EXTRA_OF else None


def _installed(library: str) -> bool:
    try:
        return find_spec(library) is not None
    except ImportError:
        return False


def _sentence(what: str, libraries: list[str]) -> str:
    extras = ",".join(dict.fromkeys(EXTRA_OF[library] for library in libraries))
    return f"{what} needs {' and '.join(libraries)}; run `pip install 'sensorfault[{extras}]'`."
