from laws.strict import promoting, strict

__all__ = ["promoting", "strict"]
