"""An autopilot's log -> its sensors, by role and number."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.guess.autopilots.fields import Field
from sensorfault.logs.held import looks_held
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import SAID

_LOOK_ROWS = 500_000
_INSTANCE = re.compile(r"(?P<table>[^\[]+)(\[(?P<instance>\d+)\])?")


@dataclass(frozen=True)
class Device:
    """Sensors of one role that are logged in a table, and in its further instances `TABLE[1]`.

    `identity`: where the device's number stands, `column` or `table.column`; the first that is there counts. A device
    that is among the sensors already is left out. `sure`: a table without a measurement is a sensor all the same.
    `number`: of the first instance, where the devices have no identity; `name`: another name than the role's.
    """

    table: str
    fields: tuple[Field, ...]
    identity: tuple[str, ...] = ()
    number: int = 1
    sure: bool = False
    name: str = ""


@dataclass(frozen=True)
class Role:
    """`name`: of its sensors, `{}` is the number. `choices`: the first with a device in the log counts.

    `of`: the role whose devices these speak of, so that they have its numbers. `single`: only the first instance.
    """

    name: str
    choices: tuple[tuple[Device, ...], ...]
    of: str = ""
    single: bool = False


def first_of(
    name: str,
    what: tuple[Field, ...],
    *tables: str,
    single: bool = False,
    sure: bool = False,
    of: str = "",
    identity: tuple[str, ...] = (),
) -> Role:
    """A role that is logged in the first of some tables, in each with the same fields."""
    return Role(name, tuple((Device(one, what, identity, sure=sure),) for one in tables), of, single)


def state(name: str, *choices: tuple[str, str]) -> Role:
    """What the vehicle does: the first (table, column) that is there."""
    return Role(
        name,
        tuple((Device(table, (Field(name, column, kind="context"),)),) for table, column in choices),
        single=True,
    )


@dataclass(frozen=True)
class Stock:
    """An autopilot. `tells`: one of these tables identifies it."""

    name: str
    tells: frozenset[str]
    roles: tuple[Role, ...]

    @property
    def tables(self) -> frozenset[str]:
        """All that may have sensors, or the numbers of devices."""
        devices = [device for role in self.roles for choice in role.choices for device in choice]
        others = {place.rpartition(".")[0] for device in devices for place in device.identity}
        return frozenset({device.table for device in devices} | others - {""})

    def sensors(self, tables: Mapping[str, Source]) -> tuple[dict[str, tuple[SensorEntry, ...]], list[str]]:
        """The sensors of each table that has some, and remarks on devices that are none."""
        search = _Search(tables)
        for role in self.roles:
            for choice in role.choices:
                if search.found(role, choice):
                    break
        used = {name: tuple(entries) for name, entries in search.entries.items()}
        return used, search.remarks


@dataclass
class _Search:
    tables: Mapping[str, Source]
    entries: dict[str, list[SensorEntry]] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    names: set[str] = field(default_factory=set)
    numbers: dict[tuple[str, float], int] = field(default_factory=dict)  # by role and identity

    def found(self, role: Role, choice: tuple[Device, ...]) -> bool:
        """Whether the log has a device of this choice; if so, they are entered."""
        count, unknown = 0, False
        for device in choice:
            for instance, table in self._instances(device.table, role.single):
                identities = self._identities(device, table)
                number = device.number + instance
                if role.of:
                    known = [self.numbers[role.of, one] for one in identities if (role.of, one) in self.numbers]
                    number = known[0] if known else number
                    if (device.identity and not known) or role.of.format(_digit(number)) not in self.names:
                        continue
                elif device.identity:
                    number = count + 1
                    if (count and unknown) or any((role.name, one) in self.numbers for one in identities):
                        continue  # nobody knows that it is another one
                    unknown |= not identities
                name = (device.name or role.name).format(_digit(number))
                if self._enter(name, device, table):
                    count += 1
                    self.numbers |= {(role.name, one): number for one in identities}
        return count > 0

    def _instances(self, base: str, single: bool) -> list[tuple[int, str]]:
        """The instances of a table that the log has, in order."""
        named = ((_INSTANCE.fullmatch(name), name) for name in self.tables)
        found = sorted((int(one["instance"] or 0), name) for one, name in named if one and one["table"] == base)
        return found[:1] if single else found

    def _identities(self, device: Device, table: str) -> list[float]:
        """The numbers of the devices whose values a table holds: one, or several where the autopilot changed it."""
        for place in device.identity:
            other, dot, column = place.rpartition(".")
            source = self.tables.get(other if dot else table)
            if source is not None and column in source.frame.columns:
                return [float(one) for one in source.frame[column].unique().to_list() if one]
        return []

    def _enter(self, name: str, device: Device, table: str) -> bool:
        """Whether the table has a sensor; a table of zeros is none."""
        source = self.tables[table]
        source = replace(source, frame=source.frame.head(_LOOK_ROWS))
        channels: dict[str, tuple[ChannelEntry, Field]] = {}
        for one in device.fields:
            entry = one.entry(source) if one.channel not in channels else None
            if entry is not None:
                channels[one.channel] = entry, one
        measured = [one for entry, one in channels.values() if entry.kind not in SAID]
        due = any(one.kind not in SAID for one in device.fields)
        if not channels or (due and not measured):
            return False
        value = np.column_stack([one.value(source) for one in measured]) if measured else np.ones((1, 1))
        fix = channels.get("fix_type")
        if not (device.sure or np.nan_to_num(value).any() or (fix and fix[1].value(source).any())):
            self.remarks.append(f"{table} has only zeros for {name}: no such device.")
            return False
        held = bool(measured) and (looks_held(value) or all(looks_held(one[:, None]) for one in value.T))
        entries = tuple(entry for entry, _ in channels.values())
        self.entries.setdefault(table, []).append(SensorEntry(name, entries, held=held))
        self.names.add(name)
        return True


def _digit(number: int) -> str:
    """The first device of a role has no number."""
    return "" if number == 1 else str(number)
