"""Name -> recipe."""

from sensorfault.logs.table import LogError
from sensorfault.methods import (
    anfis_cubature,
    ar_predictor,
    arm_kalman,
    bicycle_kalman,
    bp_autoencoder,
    car,
    chi_square_cubature,
    cooperative,
    cusum,
    double_threshold,
    drone,
    elm_autoencoder,
    elm_cross_validated,
    elm_robust,
    height_agreement,
    innovation_tests,
    kinematic_observer,
    linear_conditioning,
    linear_extrapolation,
    lof_efd,
    logistic_cubature,
    lstm_displacement,
    lstm_predictor,
    mean_pair,
    mlp_predictor,
    motion_deficit,
    multistep_observer,
    online_network,
    pca,
    persistence,
    ramp_glr,
    relative_conditioning,
    side_force,
    slope,
    train,
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
    train.RECIPE,
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
