"""Which errors are the user's to mend, and their one sentence."""


def sentence_of(error: Exception) -> str | None:
    """The sentence of a bad input, or None for an error that is ours and deserves its traceback."""
    from sensorfault.faults.fault import FaultError
    from sensorfault.logs import LogError

    if isinstance(error, (LogError, FaultError)):
        return str(error)
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}; give a path that can be read or written."
    return None
