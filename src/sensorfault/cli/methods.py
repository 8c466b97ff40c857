"""`sensorfault methods`: the catalog of methods."""

import click

from sensorfault.cli import options, show

AUTO = (
    "auto",
    "the default: each sensor against what the others say, and levels that must hold",
    "analytical redundancy",
)


@click.command("methods")
@options.json_option
def command(json_path: str | None) -> None:
    """List the methods: their parts, their source, and the false alarm rate they are designed for."""
    from sensorfault.methods.catalog import METHODS

    if json_path != "-":
        rows = [AUTO, *((recipe.name, recipe.title, recipe.source) for recipe in METHODS.values())]
        show.table("Methods", ("name", "what it is", "source"), rows)
    auto = {"name": AUTO[0], "title": AUTO[1], "source": AUTO[2], "false_alarm_rate": "none is promised"}
    listed = [
        auto,
        *(
            {
                "name": recipe.name,
                "title": recipe.title,
                "source": recipe.source,
                "false_alarm_rate": recipe.false_alarm_rate,
            }
            for recipe in METHODS.values()
        ),
    ]
    show.write_json(json_path, {"methods": listed})
