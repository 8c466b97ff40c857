"""`sensorfault demo`: the main job, on a drive that it simulates."""

from pathlib import Path

import click

from sensorfault.cli import options, show, work

LEARN_S = 240.0


@click.command("demo")
@options.out_option("demo", "The folder to write log, model, truth and page to.")
@options.method_option
@options.seed_option
@options.json_option
def command(out: Path, method: str, seed: int, json_path: str | None) -> None:
    """Simulate a 10-minute drive, let its sensors lie, and find out.

    Paper A's four kinds of fault: short, bias, jam and miss (Min et al. 2021), in the part of the drive that the method
    was not fitted on.
    """
    from sensorfault.evaluation.judge import judge
    from sensorfault.evaluation.page import write_page
    from sensorfault.faults.fault import Fault
    from sensorfault.faults.inject import inject
    from sensorfault.faults.plan import plan
    from sensorfault.faults.text import truth_to_json
    from sensorfault.logs import write
    from sensorfault.methods.catalog import recipe
    from sensorfault.methods.fit import fit
    from sensorfault.simulation.road import drive
    from sensorfault.store import save

    recipe(method)
    out.mkdir(parents=True, exist_ok=True)
    with show.progress() as bar:
        task = bar.add_task("simulating a drive of 10 minutes", total=None)
        clean = drive(600.0, seed).log
        bar.update(task, total=1, completed=1)
        task = bar.add_task(f"fitting {method} on its first {LEARN_S / 60:.0f} minutes", total=None)
        model = fit(clean.between(end_s=LEARN_S), method, seed=seed)
        bar.update(task, total=1, completed=1)
    wanted = [
        Fault("short", "gyro", "z", 0, 0, 20, sigmas=True),
        Fault("short", "accelerometer", "x", 0, 0, 20, sigmas=True),
        Fault("bias", "accelerometer", "y", 0, 15, 20, sigmas=True),
        Fault("bias", "gyro", "x", 0, 15, 20, sigmas=True),
        Fault("jam", "gyro", "y", 0, 10),
        Fault("jam", "accelerometer", None, 0, 5),
        Fault("miss", "gyro", None, 0, 5),
        Fault("miss", "gnss", None, 0, 5),
    ]
    injected = inject(clean, plan(clean, wanted, LEARN_S, 600.0, seed=seed), seed)
    judged = injected.log.between(LEARN_S)
    write(injected.log, out / "drive.csv")
    (out / "drive.truth.json").write_text(truth_to_json(injected.truth) + "\n")
    save(model, out / "car.sensorfault")
    found = work.detect(model, judged, "judging the other 6 minutes, sensors lying")
    sentences = (
        f"Fitted by {method} on the first {LEARN_S / 60:.0f} minutes.",
        *work.rate(model),
        *work.not_watched(model),
    )
    write_page(found, out / "report.html", injected.truth, "Simulated drive with injected faults", sentences)

    verdict = judge(found, injected.truth, clean)
    show.events(found.events, "Fault events (simulated drive, injected faults)", json_path != "-")
    right = sum(outcome.channel_right and outcome.kind_right for outcome in verdict.outcomes)
    seen = sum(outcome.found for outcome in verdict.outcomes)
    innocents = sum(outcome.innocents for outcome in verdict.outcomes)
    show.say(
        f"\n{seen} of {len(verdict.outcomes)} injected faults found, {right} with sensor, channel and kind right; "
        f"{innocents} events on healthy channels meanwhile, {len(verdict.false_alarms)} false alarms in "
        f"{verdict.healthy_hours * 60:.1f} healthy minutes."
    )
    for sentence in work.not_watched(model):
        show.say(sentence)
    show.say(f"Open {out / 'report.html'}; the log, the truth and the model lie beside it.")
    show.write_json(json_path, {"events": [event.as_dict() for event in found.events]})
