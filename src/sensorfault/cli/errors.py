"""Which errors a user can fix, and the sentence to print for them."""


def sentence_of(error: Exception, what: str = "this command") -> str | None:
    """The sentence for bad input or a missing extra; None for a bug, whose traceback is needed.

    `what`: what the user ran, for a sentence that says what needs the extra.
    """
    from sensorfault.core.extras import sentence_of_missing
    from sensorfault.faults.fault import FaultError
    from sensorfault.logs import LogError

    if isinstance(error, (LogError, FaultError)):
        return str(error)
    if isinstance(error, ImportError):
        return sentence_of_missing(error, what)
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}; give a path that can be read or written."
    return None
