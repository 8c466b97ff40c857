"""`sensorfault reproduce`: a paper's experiments again, ours beside its numbers."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sensorfault.cli import options, show, work

if TYPE_CHECKING:
    from sensorfault.cli.studies import Reproduction, Study

ALL = "all"


@click.command("reproduce")
@click.argument("name", metavar="STUDY", required=False)
@click.option("--seeds", default=5, show_default=True, type=click.IntRange(min=1), help="Runs that differ by chance.")
@click.option("--quick", is_flag=True, help="Less of everything, for a look; the numbers are not the study's.")
@options.out_option(None, "A folder to write STUDY.html, a page, and STUDY.json to.")
@options.json_option
def command(name: str | None, seeds: int, quick: bool, out: Path | None, json_path: str | None) -> None:
    """Run the experiments of a paper and print ours beside its numbers.

    STUDY is the name of an installed study, or all; without it the studies are listed. Their real logs are found
    through SENSORFAULT_DATA.
    """
    from sensorfault.cli.commit import commit

    if name is None:
        _list(json_path)
        return
    studies = _studies(name)
    _check_folder(out)
    pages = [out / f"{study.name}{ending}" for study in studies for ending in (".html", ".json")] if out else []
    work.check_outputs([*(path for path in pages if path.parent.is_dir()), json_path], [])
    code = commit()
    done = [_run(study, seeds, quick) for study in studies]
    for study, result in zip(studies, done, strict=True):
        _print(result, json_path != "-")
        if out is not None:
            facts = f"commit {code} · {seeds} seed{'s' * (seeds > 1)}{' · quick, for a look' * quick}"
            _write(study.name, result.page(facts), out, _answer(study.name, code, [result]))
    show.write_json(json_path, _answer(name, code, done))


def _list(json_path: str | None) -> None:
    from sensorfault.cli.studies import installed

    studies = installed().values()
    if json_path != "-":
        show.table("Studies", ("name", "paper", "what it is"), [(one.name, one.paper, one.title) for one in studies])
    listed = [{"name": one.name, "paper": one.paper, "title": one.title} for one in studies]
    show.write_json(json_path, {"studies": listed})


def _studies(name: str) -> "list[Study]":
    from sensorfault.cli.studies import installed
    from sensorfault.logs import LogError

    studies = installed()
    if name != ALL and name not in studies:
        raise LogError(f"no study is called '{name}'; take one of {', '.join(studies)}, or {ALL}.")
    return [study for study in studies.values() if name in (ALL, study.name)]


def _check_folder(out: Path | None) -> None:
    """Before the work: the folder is there or can be made."""
    from sensorfault.logs import LogError

    if out is None:
        return
    there = next(path for path in (out, *out.absolute().parents) if path.exists())
    if not there.is_dir():
        raise LogError(f"{there} is a file; give a folder to write to.")


def _run(study: "Study", seeds: int, quick: bool) -> "Reproduction":
    with show.progress() as bar:
        task = bar.add_task(study.name, total=1.0)
        result = study.reproduce(
            seeds, quick, lambda doing, share: bar.update(task, description=doing, completed=share)
        )
        bar.update(task, description=study.name, completed=1.0)
    return result


def _print(result: "Reproduction", answer: bool) -> None:
    for table in result.tables():
        show.heading(table.heading, answer)
        show.table("", table.columns, table.rows, answer, right=table.numbers)
    for remark in result.remarks:
        show.say(remark)


def _write(name: str, page: str, out: Path, answer: dict[str, Any]) -> None:
    from sensorfault.core.files import appearing

    out.mkdir(parents=True, exist_ok=True)
    with appearing(out / f"{name}.html") as temporary:
        temporary.write_text(page, encoding="utf-8")
    show.write_json(str(out / f"{name}.json"), answer)
    show.say(f"Wrote {out / name}.html and {out / name}.json.")


def _answer(name: str, code: str, done: "Sequence[Reproduction]") -> dict[str, Any]:
    return {"study": name, "commit": code, "rows": [row for result in done for row in result.records()]}
