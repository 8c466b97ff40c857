"""Which errors a user can fix, and the sentence to print for them."""


def sentence_of(error: Exception) -> str | None:
    """The sentence for bad input; None for a bug, whose traceback is needed."""
    from sensorfault.faults.fault import FaultError
    from sensorfault.logs import LogError

    if isinstance(error, (LogError, FaultError)):
        return str(error)
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}; give a path that can be read or written."
    return None
