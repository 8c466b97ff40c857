from laws.strict import strict

__all__ = ["strict"]
