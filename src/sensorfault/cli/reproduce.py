"""`sensorfault reproduce`: a paper's experiments again, ours beside its numbers."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sensorfault.cli import options, outputs, show

if TYPE_CHECKING:
    from sensorfault_studies.catalog import Study
    from sensorfault_studies.findings import Findings
    from sensorfault_studies.tables import Cell

ALL = "all"


@click.command("reproduce")
@click.argument("name", metavar="STUDY")
@click.option("--seeds", default=5, show_default=True, type=click.IntRange(min=1), help="Runs that differ by chance.")
@click.option("--quick", is_flag=True, help="Less of everything, for a look; the numbers are not the study's.")
@options.out_option(None, "A folder to write STUDY.html, a page, and STUDY.json to.")
@options.json_option
def command(name: str, seeds: int, quick: bool, out: Path | None, json_path: str | None) -> None:
    """Run the experiments of a paper and print ours beside its numbers.

    STUDY is min2021, niu1998, multistep, or all. Its real logs are found through SENSORFAULT_DATA.
    """
    from sensorfault_studies.commit import commit

    studies = _studies(name)
    _check_folder(out)
    pages = [out / f"{study.name}{ending}" for study in studies for ending in (".html", ".json")] if out else []
    outputs.check_outputs([*(path for path in pages if path.parent.is_dir()), json_path], [])
    code = commit()
    done = [_run(study, seeds, quick) for study in studies]
    for study, findings in zip(studies, done, strict=True):
        _print(study, findings, json_path != "-")
        if out is not None:
            facts = f"commit {code} · {seeds} seed{'s' * (seeds > 1)}{' · quick, for a look' * quick}"
            _write(study, findings, out, facts, _answer(study.name, code, [findings]))
    show.write_json(json_path, _answer(name, code, done))


def _studies(name: str) -> "list[Study]":
    from sensorfault.logs import LogError
    from sensorfault_studies.catalog import STUDIES

    if name != ALL and name not in STUDIES:
        raise LogError(f"{name}: there is no such study; this version has {', '.join(STUDIES)}, and {ALL} for all.")
    return [study for study in STUDIES.values() if name in (ALL, study.name)]


def _check_folder(out: Path | None) -> None:
    """Before the work: the folder is there or can be made."""
    from sensorfault.logs import LogError

    if out is None:
        return
    there = next(path for path in (out, *out.absolute().parents) if path.exists())
    if not there.is_dir():
        raise LogError(f"{there} is a file; give a folder to write to.")


def _run(study: "Study", seeds: int, quick: bool) -> "Findings":
    from sensorfault_studies.findings import Effort

    with show.progress() as bar:
        task = bar.add_task(study.name, total=1.0)
        effort = Effort(seeds, quick, lambda doing, share: bar.update(task, description=doing, completed=share))
        findings = study.run(effort)
        bar.update(task, description=study.name, completed=1.0)
    return findings


def _print(study: "Study", findings: "Findings", answer: bool) -> None:
    from sensorfault_studies.page import titled
    from sensorfault_studies.tables import grouped, tables, thinned

    for code, rows in grouped(findings.rows, lambda row: row.experiment):
        for table in tables(rows):
            show.heading(" · ".join(part for part in (titled(study, code), table.title, table.source) if part), answer)
            labels = thinned([labels for labels, _ in table.rows])
            lines = [(*left, *map(_text, cells)) for left, (_, cells) in zip(labels, table.rows, strict=True)]
            show.table("", (*table.labels, *table.heads), lines, answer, right=table.heads)
    for remark in findings.remarks:
        show.say(remark)


def _text(cell: "Cell") -> str:
    return f"{cell.value} {cell.spread}".strip()


def _write(study: "Study", findings: "Findings", out: Path, facts: str, answer: dict[str, Any]) -> None:
    from sensorfault.core.files import appearing
    from sensorfault_studies.page import page

    text = page(study, findings, facts)
    out.mkdir(parents=True, exist_ok=True)
    with appearing(out / f"{study.name}.html") as temporary:
        temporary.write_text(text, encoding="utf-8")
    show.write_json(str(out / f"{study.name}.json"), answer)
    show.say(f"Wrote {out / study.name}.html and {out / study.name}.json.")


def _answer(name: str, code: str, done: "Sequence[Findings]") -> dict[str, Any]:
    return {"study": name, "commit": code, "rows": [row.as_dict() for findings in done for row in findings.rows]}
