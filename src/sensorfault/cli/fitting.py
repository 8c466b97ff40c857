"""Find the model that judges a log: load it, or fit it on the log's beginning."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from sensorfault.cli import limits, show

if TYPE_CHECKING:
    from sensorfault.logs import Log
    from sensorfault.logs.vehicle import VehicleFile
    from sensorfault.runtime.compared import Comparison
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.streaming import Fit


INERTIAL = "relative-conditioning"  # for logs in which no two sensors measure the same


@dataclass(frozen=True)
class Choice:
    """What the user chose: a model file; or a method, and the share of the log to fit it on. No method: auto.

    Raises:
        LogError: the share is not one.
    """

    path: Path | None
    method: str | None
    learn: float
    seed: int

    def __post_init__(self) -> None:
        from sensorfault.logs import LogError

        if not 0.05 <= self.learn <= 0.95:  # click accepts NaN as a number
            raise LogError(f"--learn is {self.learn:g}; give the share of the log to fit on, 0.05 to 0.95.")


def description_of(choice: Choice, log: Path, vehicle: Path | None) -> "VehicleFile | Path | None":
    """What the columns of a log are: as the user says, else as the model was fitted, else None.

    Raises:
        LogError: the model and a vehicle.toml disagree.
    """
    from sensorfault.logs.place import find_vehicle
    from sensorfault.logs.vehicle import VehicleFile
    from sensorfault.runtime.saved import header_of

    text = header_of(choice.path).get("summary", {}).get("description") if choice.path is not None else None
    if not isinstance(text, str):
        return vehicle
    known = VehicleFile.parse(text, f"{choice.path}")
    if len({entry.path for entry in known.files}) > 1:
        return vehicle  # files of other names cannot be matched
    beside = find_vehicle(log, vehicle)
    if beside is None:
        return known
    if conflict := beside.conflict(known):
        from sensorfault.logs import LogError

        raise LogError(
            f"{vehicle or f'the vehicle.toml beside {log}'} and the model {choice.path} disagree: {conflict}."
        )
    return beside


def comparison_of(choice: Choice) -> "Comparison | None":
    """The comparison to judge with, if that is what the user chose; None if it is another method.

    Raises:
        LogError: a model of another method than the one asked for.
    """
    from sensorfault.logs import LogError
    from sensorfault.relations.events import METHOD
    from sensorfault.runtime.compared import Comparison
    from sensorfault.runtime.saved import method_of, read_comparison

    if choice.path is None:
        return Comparison() if choice.method in (None, METHOD) else None
    method = method_of(choice.path)
    if choice.method not in (None, method):
        raise LogError(f"{choice.path} is a model of {method}, not of {choice.method}; leave out --method.")
    return read_comparison(choice.path) if method == METHOD else None


def model_or_fit(choice: Choice) -> "Model | Fit":
    """The stored model, or what fits one on a log."""
    if choice.path is not None:
        from sensorfault.runtime.compared import Comparison
        from sensorfault.runtime.store import load

        model = load(choice.path)
        assert not isinstance(model, Comparison)  # comparison_of takes those
        return model

    def fitted(log: "Log") -> "Model":
        from sensorfault.methods.fit import fit

        assert choice.method is not None
        with show.progress() as bar:
            task = bar.add_task(f"fitting {choice.method}", total=None)
            model = fit(log, choice.method, held_out=0.0, seed=choice.seed)
            bar.update(task, total=1, completed=1)
        return model

    return fitted


def model_and_rest(choice: Choice, log: "Log") -> "tuple[Model, Log]":
    """The model, and the part of a whole log that it was not fitted on."""
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.streaming import beginning_s

    model = model_or_fit(choice)
    if isinstance(model, Model):
        return model, log
    start_s, cut_s = float(log.time[0]), beginning_s(log, choice.learn)
    model = model(log.between(end_s=cut_s))
    for sentence in limits.of_own_model(model, start_s, cut_s):
        show.say(sentence)
    return model, log.between(cut_s)
