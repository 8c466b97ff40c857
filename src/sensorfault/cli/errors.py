"""Which errors a user can fix, and the sentence to print for them."""

import errno

ANYWHERE = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO}  # said even where no file is named


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
    if isinstance(error, OSError) and error.filename is None and error.errno in ANYWHERE:
        return f"{error.strerror}: the output could not be written; make room, or write somewhere else."
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}; give a path that can be read or written."
    return None
