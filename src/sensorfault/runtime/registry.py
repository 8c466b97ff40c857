"""Every part a stored monitor may be made of, by name. What is not listed here is not loaded."""

import equinox as eqx

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.numerics.fuzzy import Anfis, Premises
from sensorfault.numerics.logistic import Logistic
from sensorfault.numerics.networks.dense import Dense, Linear, Mlp
from sensorfault.numerics.networks.lstm import Lstm, LstmLayer
from sensorfault.numerics.outlier_factor import LocalDensity
from sensorfault.numerics.unit_range import UnitRange
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.decision.persist import Persist
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.recovery.readmit import Readmit
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.arm_kalman import ArmKalman
from sensorfault.stages.residual.bicycle_kalman import BicycleKalman, Columns
from sensorfault.stages.residual.conditioning import Conditioning
from sensorfault.stages.residual.cubature import Cubature
from sensorfault.stages.residual.difference import Difference
from sensorfault.stages.residual.displacement import Displacement
from sensorfault.stages.residual.extrapolation import Extrapolation
from sensorfault.stages.residual.height_kalman import HeightKalman
from sensorfault.stages.residual.ins_gnss import InsGnss
from sensorfault.stages.residual.measurement_noise import SageHusa, Stated, WindowedNoise
from sensorfault.stages.residual.motion_deficit import MotionDeficit
from sensorfault.stages.residual.multistep_observer import MultistepObserver
from sensorfault.stages.residual.online_network import OnlineNetwork
from sensorfault.stages.residual.prediction import Prediction
from sensorfault.stages.residual.reconstruction import Reconstruction
from sensorfault.stages.residual.several import Several
from sensorfault.stages.residual.side_force import SideForce
from sensorfault.stages.residual.two_heights import TwoHeights
from sensorfault.stages.residual.velocity_deficit import VelocityDeficit
from sensorfault.stages.statistic.absolute import Absolute
from sensorfault.stages.statistic.agreement import Agreement
from sensorfault.stages.statistic.averaged_baarda_w import AveragedFreed
from sensorfault.stages.statistic.averaged_innovation import AveragedInnovation
from sensorfault.stages.statistic.averaged_together import AveragedTogether
from sensorfault.stages.statistic.baarda_w import Freed
from sensorfault.stages.statistic.cumulative_bank import CumulativeBank
from sensorfault.stages.statistic.cusum import Cusum
from sensorfault.stages.statistic.deficit import Deficit
from sensorfault.stages.statistic.double_threshold import DoubleThreshold
from sensorfault.stages.statistic.ewma import Ewma
from sensorfault.stages.statistic.exchange import Exchange
from sensorfault.stages.statistic.fuzzy_inference import FuzzyInference
from sensorfault.stages.statistic.horizons import Horizons
from sensorfault.stages.statistic.lasting import Lasting
from sensorfault.stages.statistic.logistic_regression import LogisticRegression
from sensorfault.stages.statistic.mahalanobis import Mahalanobis
from sensorfault.stages.statistic.mean_pair import MeanPair
from sensorfault.stages.statistic.means import Means
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.statistic.normality import Normality
from sensorfault.stages.statistic.one_sided import Late
from sensorfault.stages.statistic.outlier_factor import OutlierFactor
from sensorfault.stages.statistic.ramp_glr import RampGlr
from sensorfault.stages.statistic.relative import Relative
from sensorfault.stages.statistic.repeats import Repeats
from sensorfault.stages.statistic.select_residual import Of
from sensorfault.stages.statistic.shortfall import Shortfall
from sensorfault.stages.statistic.slippage import Slippage
from sensorfault.stages.statistic.slope import Slope
from sensorfault.stages.statistic.standardised import Standardised
from sensorfault.stages.statistic.stuck_position import Standing
from sensorfault.stages.statistic.whitened import Whitened
from sensorfault.stages.statistic.windowed import Windowed
from sensorfault.stages.statistic.windowed_chi_square import WindowedChiSquare
from sensorfault.stages.statistic.windowed_outlier_factor import WindowedOutlierFactor
from sensorfault.stages.threshold.adaptive import Adaptive
from sensorfault.stages.threshold.chi_square import ChiSquare
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.scaled_max import ScaledMax
from sensorfault.stages.threshold.sigma import Sigma
from sensorfault.vehicles.arm import TwoLink
from sensorfault.vehicles.height import Climb, StepNetwork
from sensorfault.vehicles.inertial import Inertial, SideOn
from sensorfault.vehicles.rover import Rover
from sensorfault.vehicles.train import CarrierNoise, ElevationNoise, Grade
from sensorfault.vehicles.underwater import Follower, FollowerRoles, Leader

PARTS: dict[str, type[eqx.Module]] = {
    part.__name__: part
    for part in (
        *(Monitor, Branch),
        *(Reconstruction, Conditioning, Several),
        *(Prediction, Extrapolation, Displacement, OnlineNetwork),
        *(MotionDeficit, VelocityDeficit, Inertial, SideForce, SideOn),
        *(Dense, Linear, Mlp, Lstm, LstmLayer),
        *(Norm, Absolute, Mahalanobis, Exchange, Repeats, Of, Relative),
        *(Deficit, Shortfall, Standing, Slippage, Lasting),
        *(BicycleKalman, Columns, Whitened, Normality),
        *(ArmKalman, TwoLink),
        *(MultistepObserver, Climb, StepNetwork, HeightKalman, Horizons, Adaptive),
        *(Difference, Windowed, Slope, MeanPair, RampGlr),
        *(TwoHeights, Agreement),
        *(Cubature, Stated, SageHusa, WindowedNoise, Normalised, Late, DoubleThreshold),
        *(Follower, FollowerRoles, Leader, Rover),
        *(InsGnss, Grade, ElevationNoise, CarrierNoise),
        *(FuzzyInference, Anfis, Premises, LogisticRegression, Logistic, UnitRange),
        *(AveragedInnovation, AveragedTogether, AveragedFreed, WindowedChiSquare, Cusum, Ewma),
        *(Freed, Standardised, ChiSquare),
        *(OutlierFactor, WindowedOutlierFactor, LocalDensity, CumulativeBank, Means),
        *(Fixed, ScaledMax, Sigma),
        *(Exceed, Persist),
        *(Drop, Rebuild, Readmit),
    )
}
