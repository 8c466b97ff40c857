"""Name -> recipe."""

from sensorfault.logs.table import LogError
from sensorfault.methods.arm import arm_kalman, online_network
from sensorfault.methods.composite import car, drone
from sensorfault.methods.gnss import innovation_tests, lof_efd, rail
from sensorfault.methods.height import (
    cusum,
    height_agreement,
    kinematic_observer,
    mean_pair,
    multistep_observer,
    ramp_glr,
    slope,
)
from sensorfault.methods.inertial import (
    bp_autoencoder,
    elm_autoencoder,
    elm_cross_validated,
    elm_robust,
    linear_conditioning,
    pca,
    relative_conditioning,
)
from sensorfault.methods.position import (
    ar_predictor,
    bicycle_kalman,
    linear_extrapolation,
    lstm_displacement,
    lstm_predictor,
    mlp_predictor,
    motion_deficit,
    persistence,
    side_force,
)
from sensorfault.methods.ranging import (
    anfis_cubature,
    chi_square_cubature,
    cooperative,
    double_threshold,
    logistic_cubature,
)
from sensorfault.methods.recipe import Recipe

_RECIPES = (
    elm_autoencoder.RECIPE,
    elm_cross_validated.RECIPE,
    elm_robust.RECIPE,
    bp_autoencoder.RECIPE,
    pca.RECIPE,
    linear_conditioning.RECIPE,
    relative_conditioning.RECIPE,
    lstm_predictor.RECIPE,
    lstm_displacement.RECIPE,
    mlp_predictor.RECIPE,
    ar_predictor.RECIPE,
    persistence.RECIPE,
    linear_extrapolation.RECIPE,
    motion_deficit.RECIPE,
    bicycle_kalman.RECIPE,
    side_force.RECIPE,
    car.RECIPE,
    online_network.RECIPE,
    arm_kalman.RECIPE,
    multistep_observer.RECIPE,
    kinematic_observer.RECIPE,
    cusum.RECIPE,
    ramp_glr.RECIPE,
    slope.RECIPE,
    mean_pair.RECIPE,
    height_agreement.RECIPE,
    drone.RECIPE,
    *chi_square_cubature.RECIPES,
    double_threshold.RECIPE,
    *anfis_cubature.RECIPES,
    logistic_cubature.RECIPE,
    cooperative.RECIPE,
    *innovation_tests.RECIPES,
    lof_efd.RECIPE,
    rail.RECIPE,
)
METHODS: dict[str, Recipe] = {recipe.name: recipe for recipe in _RECIPES}
DEFAULT = relative_conditioning.RECIPE.name


def recipe(name: str) -> Recipe:
    """The recipe of that name.

    Raises:
        LogError: there is none.
    """
    if name not in METHODS:
        raise LogError(f"no method is called '{name}'; take one of {', '.join(METHODS)}.")
    return METHODS[name]
