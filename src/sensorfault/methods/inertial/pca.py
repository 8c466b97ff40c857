"""Principal components, the baseline of the reconstruction methods: three components, the same limit."""

from sensorfault.logs.table import Log
from sensorfault.methods.common.rows import Training
from sensorfault.methods.inertial.reconstructed import reconstructed
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.pca import fit_pca
from sensorfault.training.session import Session


def _build(log: Log, seed: int, session: Session) -> Model:
    return reconstructed(RECIPE.name, log, lambda rows, scaling: fit_pca(rows, scaling, components=3))


RECIPE = Recipe(
    name="pca",
    title="Principal components; norm of the reconstruction error; limit: largest training error, scaled",
    source="Jackson & Mudholkar 1979; limit as in Min et al. 2021, equations (10)-(11)",
    false_alarm_rate="not designed: the limit is the largest training error, scaled; fit measures the rate on "
    "held-out data",
    build=_build,
    needs=Training.of,
)
