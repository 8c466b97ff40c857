"""Who is compared: the paper's network in three variants, what is plainer, and a filter that knows the arm."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from sensorfault.logs.table import Log
from sensorfault.methods.arm import online_network
from sensorfault.methods.arm.arm_kalman import arm_kalman
from sensorfault.methods.arm.online_network import Setting as Taught
from sensorfault.methods.catalog import METHODS
from sensorfault.numerics.two_link import Constants
from sensorfault.runtime.model import Model
from sensorfault.simulation.arm import SAMPLES
from sensorfault.training.online import Learning
from sensorfault.training.session import SILENT

NETWORK, KALMAN = "online-network", "arm-kalman"
PLAIN = ("persistence", "linear-extrapolation")
SCRATCH, AS_PRINTED = "scratch", "scratch absolute"
FIXED = "fixed"  # limits, as printed, that know nothing of how well the network has lately foretold
VARIANTS = {  # of the network, by what a row's condition calls it
    "": Learning(),
    SCRATCH: Learning(scratch=True),
    AS_PRINTED: Learning(scratch=True, rate=0.3, iterations=10, absolute=True),  # each sample to convergence
}
DEEP = Taught(Learning(hidden=10, delays=(3, 1)), rms_ticks=20, horizon=1)  # for six joints


@dataclass(frozen=True)
class Rival:
    """A method as the catalog calls it, in a variant; `build` takes a healthy log and a seed."""

    method: str
    variant: str
    build: Callable[[Log, int], Model]


def of_two_links(arm: Constants, theta: Mapping[str, float]) -> tuple[Rival, ...]:
    """On the paper's arm, whose constants the filter knows; `theta`: the paper's thresholds, by path."""
    networks = (
        Rival(NETWORK, variant, partial(_network, setting=Taught(learning, theta=theta, horizon=SAMPLES)))
        for variant, learning in VARIANTS.items()
    )
    return (*networks, *_plain(), Rival(KALMAN, "", lambda log, seed: arm_kalman(KALMAN, log, arm)))


def of_six_joints(groups: tuple[tuple[str, ...], ...]) -> tuple[Rival, ...]:
    """On the real arm, of which there is no model; `groups`: paths that are foretold apart from the others."""
    settings = {"": DEEP, FIXED: replace(DEEP, rms_ticks=0)}
    networks = (
        Rival(NETWORK, variant, partial(_network, setting=replace(setting, groups=groups)))
        for variant, setting in settings.items()
    )
    return (*networks, *_plain())


def _network(log: Log, seed: int, setting: Taught) -> Model:
    return online_network.build(log, seed, SILENT, setting)


def _plain() -> tuple[Rival, ...]:
    return tuple(Rival(method, "", partial(_of_catalog, method=method)) for method in PLAIN)


def _of_catalog(log: Log, seed: int, method: str) -> Model:
    return METHODS[method].build(log, seed, SILENT)
