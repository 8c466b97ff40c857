"""The autoencoder of Min et al. 2021 for training data with a few wrong rows."""

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
        robust=True,
    )


RECIPE = Recipe(
    name="elm-robust",
    title="Extreme-learning autoencoder; norm of the reconstruction error; limit: largest training error after "
    "removal of outliers, scaled",
    source="Min et al. 2021, section 2.1; outliers by an estimate of the tail (Hill 1975)",
    false_alarm_rate="not designed: the limit is the largest training error that is no outlier, scaled",
    build=_build,
    needs=Training.of,
)
