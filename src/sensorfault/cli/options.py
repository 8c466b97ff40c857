"""Arguments and options of several verbs."""

from collections.abc import Callable
from pathlib import Path

import click

log_argument = click.argument("log", type=click.Path(path_type=Path))
vehicle_option = click.option(
    "--vehicle",
    type=click.Path(path_type=Path),
    help="A vehicle.toml. By default the one beside the log, else a guess.",
)
rate_option = click.option(
    "--rate", "rate_hz", type=float, metavar="HZ", help="Rows a second, for tables without a clock."
)
json_option = click.option(
    "--json", "json_path", type=click.Path(path_type=str), help="Write the answer as JSON; - for standard output."
)
method_option = click.option(
    "--method", default=None, help="One of 'sensorfault methods'.  [default: relative-conditioning]"
)
fitting_method_option = click.option(
    "--method",
    default="auto",
    show_default=True,
    help="auto, car, drone, ... or another of 'sensorfault methods --all'.",
)
detecting_method_option = click.option(
    "--method",
    default=None,
    help="One of 'sensorfault methods'.  [default: auto, or the model's own]",
)
model_option = click.option(
    "--model", "model_path", type=click.Path(path_type=Path), help="A model that 'sensorfault fit' wrote."
)
learn_option = click.option(
    "--learn",
    default=0.5,
    show_default=True,
    type=click.FloatRange(0.05, 0.95),
    help="With a method other than auto and no --model: share of the log, from its beginning, to assume healthy and "
    "fit on.",
)
by_parts_option = click.option(
    "--by-parts/--whole",
    "by_parts",
    default=None,
    help="Read the log part by part, in memory that does not grow with the file, or whole. By default part by part if "
    "the file is larger than 1 GB and its format allows it.",
)
seed_option = click.option("--seed", default=0, show_default=True, type=click.IntRange(min=0))


def out_option(default: str | None, help: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """The option --out, with or without a default."""
    return click.option(
        "--out", type=click.Path(path_type=Path), default=default, show_default=bool(default), help=help
    )
