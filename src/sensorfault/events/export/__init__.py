"""Events for other programs: tables, and recordings that the field's viewers open."""

from sensorfault.events.export.write import KINDS, check, write_events

__all__ = ["KINDS", "check", "write_events"]
