"""Which errors are the user's to mend, and their one sentence."""


def sentence_of(error: Exception, what: str = "this command") -> str | None:
    """The sentence of a bad input or a missing extra, or None for an error that is ours and deserves its traceback.

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
