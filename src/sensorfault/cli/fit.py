"""`sensorfault fit`: fit a model on a healthy log."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from sensorfault.cli import fitting, limits, options, outputs, reading, show
from sensorfault.core.files import safe_name

if TYPE_CHECKING:
    from sensorfault.logs import Log


@click.command("fit")
@options.log_argument
@options.vehicle_option
@options.rate_option
@options.fitting_method_option
@options.out_option(None, "The model file to write.  [default: NAME.sensorfault here]")
@click.option("--until", "until_s", type=float, help="Use the log only up to this time [s].")
@click.option(
    "--held-out",
    default=0.3,
    show_default=True,
    help="Share of the log, at its end, to count false alarms on.",
)
@click.option(
    "--checkpoint",
    type=click.Path(path_type=Path),
    help="For methods trained by epochs: a file that is saved after every epoch, and resumed from if present.",
)
@options.seed_option
@options.json_option
def command(
    log: Path,
    vehicle: Path | None,
    rate_hz: float | None,
    method: str,
    out: Path | None,
    until_s: float | None,
    held_out: float,
    checkpoint: Path | None,
    seed: int,
    json_path: str | None,
) -> None:
    """Fit a method on a healthy log, and count its false alarms on the part held out."""
    from sensorfault.runtime.names import is_default, recipe_of, vehicle_of

    if not is_default(method):
        from sensorfault.methods.catalog import recipe

        method = recipe(recipe_of(method)).name
    outputs.check_outputs([out, json_path, checkpoint], [log, vehicle])
    table = reading.read_log(log, vehicle, rate_hz=rate_hz)
    if until_s is not None:
        table = table.between(end_s=until_s)
    if is_default(method):
        if _compare(table, vehicle_of(method), out, json_path):
            return
        method = fitting.INERTIAL
        show.say(f"No two of its sensors measure the same: {method} is fitted, which judges each channel by itself.")
    from sensorfault.methods.fit import fit
    from sensorfault.runtime.store import save

    with show.progress() as bar:
        task = bar.add_task(f"fitting {method}", total=None)
        model = fit(table, method, held_out, seed, lambda doing: bar.update(task, description=doing), checkpoint)
        bar.update(task, total=1, completed=1, description=f"fitted {method}")
    target = out or Path(f"{safe_name(table.name)}.sensorfault")
    save(model, target)
    watched = [c.path for c, w in zip(model.channels, model.watched, strict=True) if w]
    show.say(limits.watches(watched))
    for sentence in (*limits.suspects(model), *limits.not_watched(model), *limits.smallest(model), *limits.rate(model)):
        show.say(sentence)
    show.say(f"Wrote {target}.")
    show.write_json(json_path, {"model": str(target), "method": method, "watched": watched, **model.summary})


def _compare(log: "Log", vehicle: str, out: Path | None, json_path: str | None) -> bool:
    """Fit the default method: what the sensors of a healthy log say of each other. False if no two say the same."""
    from sensorfault.runtime.compared import NothingToCompare, comparison_of
    from sensorfault.runtime.saved import write_comparison

    try:
        comparison = comparison_of(log, vehicle=vehicle)
    except NothingToCompare:
        return False
    target = out or Path(f"{safe_name(log.name)}.sensorfault")
    write_comparison(comparison, target)
    for sentence in limits.of_comparison(comparison):
        show.say(sentence)
    show.say(f"Wrote {target}.")
    show.write_json(json_path, {"model": str(target), "method": comparison.method, **comparison.summary})
    return True
