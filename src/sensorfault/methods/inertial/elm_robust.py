"""Paper A's autoencoder for training data in which a few rows are wrong."""

from functools import partial

from sensorfault.logs.table import Log
from sensorfault.methods.common.multivariate import Training
from sensorfault.methods.inertial.reconstructed import reconstructed
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.elm import fit_elm
from sensorfault.training.session import Session


def _build(log: Log, seed: int, session: Session) -> Model:
    return reconstructed(
        RECIPE.name,
        log,
        lambda rows, scaling: fit_elm(rows, scaling, hidden=32, c=1e3, seed=seed),
        robust=True,
    )


RECIPE = Recipe(
    name="elm-robust",
    title="Extreme-learning autoencoder, norm of the reconstruction error, scaled largest that the others explain",
    source="Min et al. 2021, section 2.1; extremes as far as the tail explains them (Hill 1975)",
    promise="none: the limit is the largest explained training error, scaled",
    build=_build,
    needs=partial(Training.of, "elm-robust"),
)
