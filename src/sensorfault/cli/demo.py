"""`sensorfault demo`: detection on a simulated drive or flight."""

from pathlib import Path

import click

from sensorfault.cli import detecting, limits, options, show


@click.command("demo")
@options.out_option("demo", "The folder to write log, model, truth and page to.")
@click.option(
    "--flight",
    is_flag=True,
    help="Simulate a flight of a flapping wing; default method: height-agreement.",
)
@options.method_option
@options.seed_option
@options.json_option
def command(out: Path, flight: bool, method: str | None, seed: int, json_path: str | None) -> None:
    """Simulate a 10-minute drive, inject sensor faults, and detect them.

    The faults are spikes, offsets, frozen and missing values (Min et al. 2021), in the part of the drive that the
    method was not fitted on. With --flight, a 20-minute flight on which the receiver's height drifts and jumps.
    """
    from sensorfault.cli.scenarios import DRIVE, FLIGHT
    from sensorfault.core.extras import require
    from sensorfault.evaluation.judge import judge
    from sensorfault.faults.inject import inject
    from sensorfault.faults.plan import plan
    from sensorfault.faults.text import truth_to_json
    from sensorfault.logs import write
    from sensorfault.methods.catalog import recipe
    from sensorfault.methods.fit import fit
    from sensorfault.report.page import write_page
    from sensorfault.runtime.store import save

    require("`sensorfault demo`", "polars", "plotly")
    scenario = FLIGHT if flight else DRIVE
    method = method or scenario.method
    recipe(method)
    out.mkdir(parents=True, exist_ok=True)
    with show.progress() as bar:
        task = bar.add_task(f"simulating a {scenario.words}", total=None)
        clean = scenario.make(seed)
        bar.update(task, total=1, completed=1)
        task = bar.add_task(f"fitting {method} on its first {scenario.learn_s / 60:.0f} minutes", total=None)
        model = fit(clean.between(end_s=scenario.learn_s), method, seed=seed)
        bar.update(task, total=1, completed=1)
    injected = inject(clean, plan(clean, scenario.faults, scenario.learn_s, pause_s=scenario.pause_s, seed=seed), seed)
    judged = injected.log.between(scenario.learn_s)
    write(injected.log, out / f"{scenario.words}.csv")
    (out / f"{scenario.words}.truth.json").write_text(truth_to_json(injected.truth) + "\n")
    save(model, out / f"{scenario.vehicle}.sensorfault")
    found = detecting.detect(model, judged, "judging the rest, with faults")
    sentences = (
        f"Fitted by {method} on the first {scenario.learn_s / 60:.0f} minutes.",
        *limits.rate(model),
        *limits.not_watched(model),
    )
    write_page(
        found, out / "report.html", injected.truth, f"Simulated {scenario.words} with injected faults", sentences
    )

    verdict = judge(found, injected.truth, clean)
    show.events(found.events, f"Fault events (simulated {scenario.words}, injected faults)", json_path != "-")
    right = sum(outcome.channel_right and outcome.kind_right for outcome in verdict.outcomes)
    seen = sum(outcome.found for outcome in verdict.outcomes)
    false_isolations = sum(outcome.false_isolations for outcome in verdict.outcomes)
    show.say(
        f"\n{seen} of {len(verdict.outcomes)} injected faults found, {right} with sensor, channel and kind right; "
        f"{false_isolations} events on healthy channels during the faults, {len(verdict.false_alarms)} false alarms in "
        f"{verdict.healthy_hours * 60:.1f} healthy minutes."
    )
    for sentence in limits.not_watched(model):
        show.say(sentence)
    show.say(f"Open {out / 'report.html'}; the log, the truth and the model are beside it.")
    show.write_json(json_path, {"events": [event.as_dict() for event in found.events]})
