"""Arguments and options of several verbs."""

import re
from collections.abc import Callable
from pathlib import Path

import click

_SIZE = re.compile(r"\s*(\d+(?:\.\d+)?)\s*([kMGT]?)B?\s*", re.IGNORECASE)
_BYTES = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9, "t": 10**12}


def _may_unpack(context: click.Context, option: click.Parameter, size: str | None) -> None:
    """Allow packed logs of this size."""
    if size is None:
        return
    match = _SIZE.fullmatch(size)
    if match is None:
        raise click.BadParameter(f"'{size}' is no size; give one as 20GB or 500MB.")
    from sensorfault.logs.readers.gzipped import most

    most.size = round(float(match[1]) * _BYTES[match[2].lower()])


def log_argument(command: Callable[..., None]) -> Callable[..., None]:
    """The log, and how large it may be if it is packed."""
    argument = click.argument("log", type=click.Path(path_type=Path))
    max_size = click.option(
        "--max-size",
        metavar="SIZE",
        expose_value=False,
        callback=_may_unpack,
        help="How large a packed log may be unpacked, as 20GB.  [default: this machine's memory]",
    )
    return argument(max_size(command))


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
