"""`sensorfault methods`: the catalog."""

import click

from sensorfault.cli import options, show


@click.command("methods")
@options.json_option
def command(json_path: str | None) -> None:
    """List the methods: their parts, their source, and the false alarm rate they are designed for."""
    from sensorfault.methods.catalog import METHODS

    if json_path != "-":
        rows = [(recipe.name, recipe.title, recipe.source) for recipe in METHODS.values()]
        show.table("Methods", ("name", "what it is", "source"), rows)
    listed = [
        {
            "name": recipe.name,
            "title": recipe.title,
            "source": recipe.source,
            "false_alarm_rate": recipe.false_alarm_rate,
        }
        for recipe in METHODS.values()
    ]
    show.write_json(json_path, {"methods": listed})
