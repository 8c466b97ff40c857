"""Write events for other programs: tables, and recordings for viewers."""

from sensorfault.events.export.write import KINDS, check, write_events

__all__ = ["KINDS", "check", "write_events"]
