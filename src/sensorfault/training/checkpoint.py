"""An unfinished training in one safetensors file, which is written completely or not at all."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save_file

from sensorfault.core.files import appearing
from sensorfault.logs.table import LogError

FORMAT = "sensorfault checkpoint 1"
Tree = TypeVar("Tree")


@dataclass(frozen=True)
class Checkpoint:
    """The file in which a training is saved after every epoch, and from which it resumes; none if `path` is None.

    `training`: a digest of everything that determines the training: network, examples, plan and seed.
    """

    path: Path | None
    training: str

    @classmethod
    def of(cls, path: Path | None, now: Any, *decides: Any) -> "Checkpoint":
        """For the training determined by `decides`: arrays by their contents, all else by its printed form."""
        digest = hashlib.sha256(str(jax.tree.structure((now, decides))).encode())
        for leaf in jax.tree.leaves(decides):
            part = np.asarray(leaf) if isinstance(leaf, np.ndarray | jax.Array) else np.array(repr(leaf))
            digest.update(f"{part.dtype.str} {part.shape}".encode() + part.tobytes())
        return cls(path, digest.hexdigest())

    def write(self, now: Any, learned: list[float], validated: list[float]) -> None:
        """Save the state of the training."""
        if self.path is None:
            return
        tensors = {str(i): np.asarray(leaf) for i, leaf in enumerate(jax.tree.leaves(now))}
        errors = {"learned": np.array(learned), "validated": np.array(validated)}
        with appearing(self.path) as temporary:
            save_file(tensors | errors, temporary, {"format": FORMAT, "training": self.training})

    def resumed(self, now: Tree) -> tuple[Tree, list[float], list[float]]:
        """The training as last saved, or `now` and no errors if there is no file.

        Raises:
            LogError: the file is not a checkpoint, or is one of another training.
        """
        if self.path is None or not self.path.exists():
            return now, [], []
        other = "remove it, or give another file to write to"
        try:
            with safe_open(self.path, framework="numpy") as file:
                meta = file.metadata() or {}
                tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
        except (SafetensorError, OSError, ValueError) as error:
            raise LogError(f"{self.path}: not a checkpoint, or cut short ({error}); {other}.") from None
        if meta.get("format") != FORMAT:
            raise LogError(f"{self.path}: not a checkpoint of this version; {other}.")
        if meta.get("training") != self.training:
            raise LogError(f"{self.path}: a checkpoint of another log, method or seed; {other}.")
        leaves, structure = jax.tree.flatten(now)
        back = [jnp.asarray(tensors[str(i)]) for i in range(len(leaves))]
        learned, validated = (tensors[name].tolist() for name in ("learned", "validated"))
        return jax.tree.unflatten(structure, back), learned, validated
