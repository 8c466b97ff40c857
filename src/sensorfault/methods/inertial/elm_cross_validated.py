"""The autoencoder of Min et al. 2021 with a limit found by cross-validation."""

from sensorfault.logs.table import Log
from sensorfault.methods.common.rows import Training
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
        cross_validated=True,
    )


RECIPE = Recipe(
    name="elm-cross-validated",
    title="Extreme-learning autoencoder; norm of the reconstruction error; limit: largest error on blocks left out, "
    "scaled",
    source="Min et al. 2021, section 2.1, with cross-validation in place of the training error of equation (10)",
    false_alarm_rate="not designed: the limit is the largest error on healthy blocks left out of the fit, scaled",
    build=_build,
    needs=Training.of,
)
