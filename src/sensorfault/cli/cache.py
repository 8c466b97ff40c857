"""`sensorfault cache`: the compiled programs kept on disk."""

import click

from sensorfault.cli import options, show


@click.command("cache")
@click.option("--clear", is_flag=True, help="Remove all programs; they are compiled again when needed.")
@options.json_option
def command(clear: bool, json_path: str | None) -> None:
    """Say where compiled programs are kept and how many, or remove them.

    The first run of a method on a machine compiles it; later runs read the program from this folder. Set
    SENSORFAULT_CACHE to another folder, or to off.
    """
    from sensorfault.core.compiled import MOST_BYTES, VARIABLE, Programs, Unusable, folder

    home = folder()
    if home is None:
        show.say(f"The cache is off ({VARIABLE}).")
        show.write_json(json_path, {"folder": None, "programs": 0, "bytes": 0})
        return
    programs = Programs(home)
    try:
        programs.prepare()
    except Unusable as error:
        raise click.ClickException(str(error)) from None
    if clear:
        show.say(f"Removed {programs.clear()} programs from {home}.")
    entries = programs.sizes()
    size = sum(bytes_ for _, bytes_ in entries.values())
    if not clear:
        show.say(f"{len(entries)} programs, {size / 1e6:.1f} MB of at most {MOST_BYTES / 1e6:.0f} MB, in {home}.")
    show.write_json(json_path, {"folder": str(home), "programs": len(entries), "bytes": size})
