"""A study's rows as tables for people: methods down, magnitudes or metrics across, the paper's beside ours."""

import math
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

from sensorfault_studies.findings import Row

SOURCES = {"real": "real logs", "injected": "real logs with injected faults", "simulated": "simulated"}
PAPER = "paper"
NONE = "–"
_WIDE = 10  # more magnitudes than so many go down instead of across
_SCALE = {"spike": "σ", "frozen": "s", "missing": "s"}

Key = TypeVar("Key", bound=Hashable)


@dataclass(frozen=True)
class Cell:
    """One number as text, and its spread over the seeds; empty where there is none."""

    value: str = ""
    spread: str = ""


@dataclass(frozen=True)
class Table:
    """`labels`: heads of the columns that say what a row is, `heads`: of those with numbers; `source`: of its data.

    Where the paper prints a number, a column PAPER stands beside ours.
    """

    title: str
    source: str
    labels: tuple[str, ...]
    heads: tuple[str, ...]
    rows: tuple[tuple[tuple[str, ...], tuple[Cell, ...]], ...]


def tables(rows: Sequence[Row]) -> tuple[Table, ...]:
    """Sweeps over magnitudes first, then what was measured once; one table for each fault and source."""
    sweeps, single = [], []
    for (fault, source), group in grouped(rows, lambda row: (row.fault, row.source)):
        sizes = {row.magnitude for row in group} - {None}
        across = [row for row in group if len(sizes) > 1 and row.magnitude is not None]
        if across:
            sweeps.append(_sweep(fault or "", source, across))
        rest = [row for row in group if row not in across]
        single += [_single(fault, source, part) for part in _apart(rest)]
    return (*sweeps, *single)


def _sweep(fault: str, source: str, rows: Sequence[Row]) -> Table:
    sizes = sorted({row.magnitude for row in rows if row.magnitude is not None})
    unit = f" [{_SCALE[fault]}]" if fault in _SCALE else ""
    if len(sizes) > _WIDE:
        return _table(
            fault, source, rows, f"magnitude{unit}", lambda row: written(row.magnitude), lambda row: row.metric
        )
    title = f"{fault} by magnitude{unit}".strip()
    heads = [written(size) for size in sizes]
    return _table(title, source, rows, "metric", lambda row: row.metric, lambda row: written(row.magnitude), heads)


def _apart(rows: Sequence[Row]) -> list[list[Row]]:
    """Rows in parts that have no metric in common, so that no table is mostly empty."""
    parts: list[tuple[set[str], list[Row]]] = []
    for _, line in grouped(rows, lambda row: (row.data, row.method, row.condition)):
        metrics, together = {row.metric for row in line}, line
        for part in [part for part in parts if part[0] & metrics]:
            metrics, together = part[0] | metrics, part[1] + together
            parts.remove(part)
        parts.append((metrics, together))
    return [part for _, part in parts]


def _single(fault: str | None, source: str, rows: Sequence[Row]) -> Table:
    sizes = {row.magnitude for row in rows} - {None}
    size = f" of {written(sizes.pop())} {_SCALE.get(fault or '', '')}".rstrip() if sizes else ""
    return _table(f"{fault or ''}{size}", source, rows, "", lambda row: "", lambda row: row.metric)


def _table(
    title: str,
    source: str,
    rows: Sequence[Row],
    extra: str,
    second: Callable[[Row], str],
    across: Callable[[Row], str],
    heads: Sequence[str] = (),
) -> Table:
    """Rows by data, `second` (under the head `extra`), method and condition; columns by `across`."""
    heads = heads or list(dict.fromkeys(across(row) for row in rows))
    names = ("data", extra, "method", "condition")
    lines = grouped(rows, lambda row: (row.data, second(row), row.method, row.condition))
    order = [list(dict.fromkeys(key[i] for key, _ in lines)) for i in range(4)]
    lines.sort(key=lambda line: tuple(order[i].index(part) for i, part in enumerate(line[0])))
    shown = [i for i in range(4) if order[i] != [""]]
    papers = {across(row) for row in rows if row.paper is not None}
    columns = [(head, paper) for head in heads for paper in ((False, True) if head in papers else (False,))]
    result = []
    for key, line in lines:
        at = {across(row): row for row in line}
        cells = tuple(Cell() if head not in at else (printed if paper else ours)(at[head]) for head, paper in columns)
        result.append((tuple(key[i] for i in shown), cells))
    labels = tuple(names[i] for i in shown)
    return Table(
        title, SOURCES[source], labels, tuple(PAPER if paper else head for head, paper in columns), tuple(result)
    )


def ours(row: Row) -> Cell:
    """A row's number; as many digits as its spread deserves."""
    if not math.isfinite(row.value):
        return Cell(NONE)
    digits = _digits(row.value)
    digits = max(digits, _decimals(row.paper)) if digits >= 2 else digits
    if row.spread and digits == 2 and abs(row.value) < 1 and row.spread < 0.005:
        digits = 3
    spread = "" if row.spread is None or not math.isfinite(row.spread) else f"±{row.spread:.{digits}f}"
    return Cell(f"{row.value:.{digits}f}", spread)


def printed(row: Row) -> Cell:
    """The paper's number."""
    if row.paper is None:
        return Cell()
    return Cell(f"{row.paper:.{max(_digits(row.paper), _decimals(row.paper))}f}" if math.isfinite(row.paper) else NONE)


def _decimals(paper: float | None) -> int:
    """Digits behind the point that the paper prints; ours get no fewer where it is a small number."""
    return len(f"{paper:g}".partition(".")[2]) if paper is not None and math.isfinite(paper) else 0


def _digits(value: float) -> int:
    """Digits behind the point: none from a hundred on, one from ten on, else two; of less than 0.01 two that count."""
    size = abs(value)
    if size >= 10:
        return 0 if size >= 100 else 1
    return 2 if size >= 0.01 or size == 0 else min(6, 1 - math.floor(math.log10(size)))


def written(number: float | None) -> str:
    """A magnitude as one would write it."""
    return "" if number is None else f"{number:g}"


def grouped(rows: Iterable[Row], key: Callable[[Row], Key]) -> list[tuple[Key, list[Row]]]:
    """Rows with the same key together, in the order in which the keys first came."""
    found: dict[Key, list[Row]] = {}
    for row in rows:
        found.setdefault(key(row), []).append(row)
    return list(found.items())


def titled(experiments: Mapping[str, str], code: str) -> str:
    """An experiment's code and its title, if it has one."""
    return f"{code} {experiments[code]}" if code in experiments else code


def thinned(labels: Sequence[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Labels without what only repeats the line above; the last stands in every line."""
    shown = list(labels[:1])
    for before, line in pairwise(labels):
        changed = next((i for i, part in enumerate(line) if part != before[i]), len(line) - 1)
        shown.append(tuple("" if i < changed else part for i, part in enumerate(line)))
    return shown
