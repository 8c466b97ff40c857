"""`make fuzz`: many damaged files a reader, each reader in a process of its own, as damage may end the interpreter."""

import faulthandler
import subprocess
import sys
import tempfile
from pathlib import Path

import click

from fuzz.dialect_reading import ENOUGH, read_drawn
from fuzz.reading import Fuzzed
from fuzz.small import SMALL


@click.command()
@click.option("--files", default=10_000, show_default=True, help="Damaged files a format.")
@click.option("--only", type=click.Choice(list(SMALL)), help="One format, in this very process.")
@click.option("--tables", default=2000, show_default=True, help="Dialects of text tables.")
@click.option("--keep", type=click.Path(path_type=Path), help="Folder for the files that went wrong.")
def main(files: int, only: str | None, tables: int, keep: Path | None) -> None:
    """Damage small files and read them. Prints a line a format, and the first damages that went wrong."""
    if only:
        sys.exit(one_format(only, files, keep))
    again = [sys.executable, "-m", "fuzz", "--files", str(files), *(("--keep", str(keep)) if keep else ())]
    ended = {title: subprocess.run([*again, "--only", title], check=False).returncode for title in SMALL}
    ended["table dialects"] = dialects(tables)
    crashed = [title for title, code in ended.items() if code not in (0, 1)]
    if crashed:
        print(f"ended the interpreter: {', '.join(crashed)}")
    sys.exit(1 if any(ended.values()) else 0)


def dialects(draws: int) -> int:
    """Write and read so many tables, each in a dialect of its own; 1 if fewer than 95 % are read."""
    with tempfile.TemporaryDirectory() as folder:
        tally = read_drawn(Path(folder), draws)
    print(f"{'table dialects':32}{tally.read:7} read{tally.refused.total():7} refused")
    for reason, count in tally.refused.most_common(5):
        print(f"    {count} times: {reason[:300]}")
    return 0 if tally.share >= ENOUGH else 1


def one_format(title: str, files: int, keep: Path | None) -> int:
    """Read so many damaged files of one format; 1 if anything went wrong."""
    faulthandler.enable()
    wrong: dict[int, str] = {}
    with tempfile.TemporaryDirectory() as folder:
        fuzzed = Fuzzed(title, Path(folder))
        for number in range(files):
            said = fuzzed.one(number)
            if said is not None:
                wrong[number] = said
    print(
        f"{title:32}{fuzzed.read:7} read{fuzzed.refused:7} refused{len(wrong):5} wrong, slowest {fuzzed.seconds:.2f} s"
    )
    for said in list(wrong.values())[:5]:
        print(f"    {said[:300]}")
    if keep and wrong:
        keep.mkdir(parents=True, exist_ok=True)
        for number in wrong:
            (keep / f"{number}.{fuzzed.sound.name}").write_bytes(fuzzed.damaged(number))
    return 1 if wrong else 0


if __name__ == "__main__":
    main()
