"""`sensorfault methods`: the catalog of methods."""

import click

from sensorfault.cli import options, show


@click.command("methods")
@click.option(
    "--all", "all_of_them", is_flag=True, help="Also the methods of the papers, and what they are compared with."
)
@options.json_option
def command(json_path: str | None, all_of_them: bool) -> None:
    """List the methods: a handful by what they are for; with --all also those of the papers, with their sources."""
    from sensorfault.methods.catalog import METHODS
    from sensorfault.runtime.names import CHANNELS, VEHICLES

    named = [*VEHICLES.items(), *((name, f"{title} ({recipe})") for name, (recipe, title) in CHANNELS.items())]
    if json_path != "-":
        show.table("Methods", ("name", "what it is"), named)
        if all_of_them:
            rows = [(recipe.name, recipe.title, recipe.source) for recipe in METHODS.values()]
            show.table("Methods of the papers, and others", ("name", "what it is", "source"), rows)
        else:
            show.say(f"--all lists {len(METHODS)} more: those of the papers, and what they are compared with.")
    listed = [
        *(
            {"name": name, "title": title, "source": "", "false_alarm_rate": "none is promised"}
            for name, title in named
        ),
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
