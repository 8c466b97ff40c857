"""Entries of a vehicle file as TOML text, with their reasons as comments."""

import json

from sensorfault.logs.entries import FileEntry, SensorEntry
from sensorfault.logs.table import SAID


def file_lines(file: FileEntry) -> list[str]:
    """The table [file.NAME]."""
    lines = [f"[file.{key_of(file.name)}]"]
    names = {"path": file.path, "table": file.table, "time": file.time, "fine": file.fine}
    lines += [f"{key} = {quote(value)}" for key, value in names.items() if value is not None]
    clock = f"unit = {quote(file.unit)}" if file.rate_hz is None else f"rate_hz = {file.rate_hz!r}"
    lines.append(clock + remark(file.why))
    if file.offset_s:
        lines.append(f"offset_s = {file.offset_s!r}")
    if file.tag is not None:
        lines.append(f"tag = {quote(file.tag)}")
    if file.left_out:
        lines.append("# Columns left out:")
        lines += [comment(f"  {column}: {reason}") for column, reason in file.left_out]
    return lines


def sensor_lines(sensor: SensorEntry, single: bool) -> list[str]:
    """The tables [sensor.NAME] and [sensor.NAME.channel]; `single`: the log is one file, so it need not be named."""
    lines = [f"[sensor.{key_of(sensor.name)}]" + remark(sensor.why)]
    if not (single and sensor.file == "log"):
        lines.append(f"file = {quote(sensor.file)}")
    if sensor.held:
        lines.append("held = true")
    if sensor.epoch is not None:
        lines.append(f"epoch = {quote(sensor.epoch)}")
    judged = [channel for channel in sensor.channels if channel.kind not in SAID]
    blind = bool(judged) and not any(channel.watch for channel in judged)  # said once for all of its channels
    if blind:
        lines.append("watch = false")
    if sensor.period_s is not None:
        lines.append(f"period_s = {sensor.period_s!r}")
    lines.append(f"[sensor.{key_of(sensor.name)}.channel]")
    for channel in sensor.channels:
        cell = f"column = {quote(channel.column)}, unit = {quote(channel.unit)}"
        cell += f", missing = {channel.missing!r}" if channel.missing is not None else ""
        cell += f", epoch = {quote(channel.epoch)}" if channel.epoch is not None else ""
        cell += f", valid = {quote(channel.valid)}" if channel.valid is not None else ""
        cell += f", kind = {quote(channel.kind)}" if channel.kind else ""
        cell += "" if channel.watch or blind or channel.kind in SAID else ", watch = false"
        lines.append(f"{key_of(channel.name)} = {{ {cell} }}" + remark(channel.why))
    return lines


def comment(text: str) -> str:
    """A line of comment; what would end the line is a blank."""
    return "#" + "".join(letter if letter.isprintable() else " " for letter in f" {text}")


def remark(text: str) -> str:
    """A comment behind a line, if there is one."""
    return f"  {comment(text)}" if text else ""


def quote(text: str) -> str:
    """A text as TOML writes it."""
    return json.dumps(text, ensure_ascii=False)


def key_of(name: str) -> str:
    """A key, in quotes where it must be."""
    bare = name.isascii() and name.replace("_", "").replace("-", "").isalnum()
    return name if bare else quote(name)
