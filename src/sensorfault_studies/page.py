"""The page of a study: its tables, figures and remarks in one HTML file that opens anywhere, offline."""

import json
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from string import Template

from sensorfault.evaluation.plain import plain
from sensorfault_studies.findings import Figure, Findings
from sensorfault_studies.tables import PAPER, Cell, Table, grouped, tables, thinned, titled


def page(title: str, experiments: Mapping[str, str], findings: Findings, facts: str) -> str:
    """The page as text.

    A figure whose name begins with an experiment's code stands below its tables; the others stand at the end.

    Args:
        title: of the study.
        experiments: the title of each experiment by its code.
        findings: what to show.
        facts: commit and effort in one line.
    """
    from plotly.offline import get_plotlyjs

    here, shared = files("sensorfault_studies"), files("sensorfault.report")
    codes = [code for code, _ in grouped(findings.rows, lambda row: row.experiment)]
    home = {figure.name: _home(figure, codes) for figure in findings.figures}
    sections = [
        f"<h2>{escape(titled(experiments, code))}</h2>"
        + "".join(_table(table) for table in tables(rows))
        + _figures([figure for figure in findings.figures if home[figure.name] == code])
        for code, rows in grouped(findings.rows, lambda row: row.experiment)
    ]
    rest = [figure for figure in findings.figures if home[figure.name] is None]
    sections += [f"<h2>Figures</h2>{_figures(rest)}"] if rest else []
    charts = {f"figure-{figure.name}": figure.plot for figure in findings.figures}
    return Template(here.joinpath("page.html").read_text("utf-8")).substitute(
        title=escape(title),
        style=shared.joinpath("page.css").read_text("utf-8") + here.joinpath("page.css").read_text("utf-8"),
        facts=escape(facts),
        experiments="".join(sections),
        remarks=_remarks(findings.remarks),
        figures=json.dumps(plain(charts), allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
        plotly=get_plotlyjs(),
        script=shared.joinpath("page_base.js").read_text("utf-8") + here.joinpath("page.js").read_text("utf-8"),
    )


def _home(figure: Figure, codes: Sequence[str]) -> str | None:
    """The experiment whose name a figure's begins with; the longest name, if several do."""
    own = (code for code in codes if figure.name.lower().startswith(code.lower()))
    return max(own, key=len, default=None)


def _table(table: Table) -> str:
    heads = "".join(f"<th>{escape(label)}</th>" for label in table.labels)
    kinds = ["number paper" if head == PAPER else "number" for head in table.heads]
    heads += "".join(f'<th class="{kind}">{escape(head)}</th>' for head, kind in zip(table.heads, kinds, strict=True))
    rows = []
    for shown, (_, cells) in zip(thinned([labels for labels, _ in table.rows]), table.rows, strict=True):
        words = "".join(f"<td>{escape(word)}</td>" for word in shown)
        numbers = "".join(f'<td class="{kind}">{_cell(c)}</td>' for c, kind in zip(cells, kinds, strict=True))
        rows.append(f'<tr class="{"first" if shown[0] else ""}">{words}{numbers}</tr>')
    title = f"<h3>{escape(table.title)} <small>{escape(table.source)}</small></h3>"
    return (
        f'{title}<div class="wide"><table><thead><tr>{heads}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'
    )


def _cell(cell: Cell) -> str:
    return cell.value + (f"<small>{cell.spread}</small>" if cell.spread else "")


def _figures(figures: Sequence[Figure]) -> str:
    places = [
        f'<figure><h3>{escape(figure.title)}</h3><div class="plot" id="figure-{escape(figure.name)}"></div>'
        f"<figcaption>{escape(figure.caption)}</figcaption></figure>"
        for figure in figures
    ]
    return f'<div class="figures">{"".join(places)}</div>' if places else ""


def _remarks(remarks: Sequence[str]) -> str:
    lines = "".join(f"<li>{escape(remark)}</li>" for remark in remarks)
    return f"<h2>Remarks</h2><ul>{lines}</ul>" if remarks else ""
