"""Readers: one file -> its columns, as they stand in it; one module a format."""
