"""Every part a stored monitor may be made of, by name. What is not listed here is not loaded."""

import equinox as eqx

from sensorfault.monitor.decision.exceed import Exceed
from sensorfault.monitor.decision.persist import Persist
from sensorfault.monitor.monitor import Branch, Monitor
from sensorfault.monitor.recovery.drop import Drop
from sensorfault.monitor.recovery.readmit import Readmit
from sensorfault.monitor.recovery.rebuild import Rebuild
from sensorfault.monitor.residual.arm_kalman import ArmKalman
from sensorfault.monitor.residual.bicycle_kalman import BicycleKalman, Columns
from sensorfault.monitor.residual.conditioning import Conditioning
from sensorfault.monitor.residual.cubature import Cubature
from sensorfault.monitor.residual.difference import Difference
from sensorfault.monitor.residual.displacement import Displacement
from sensorfault.monitor.residual.extrapolation import Extrapolation
from sensorfault.monitor.residual.height_kalman import HeightKalman
from sensorfault.monitor.residual.ins_gnss import InsGnss
from sensorfault.monitor.residual.measurement_noise import SageHusa, Stated, WindowedNoise
from sensorfault.monitor.residual.motion_deficit import MotionDeficit
from sensorfault.monitor.residual.multistep_observer import MultistepObserver
from sensorfault.monitor.residual.online_network import OnlineNetwork
from sensorfault.monitor.residual.prediction import Prediction
from sensorfault.monitor.residual.reconstruction import Reconstruction
from sensorfault.monitor.residual.several import Several
from sensorfault.monitor.residual.side_force import SideForce
from sensorfault.monitor.residual.two_heights import TwoHeights
from sensorfault.monitor.residual.velocity_deficit import VelocityDeficit
from sensorfault.monitor.statistic.absolute import Absolute
from sensorfault.monitor.statistic.agreement import Agreement
from sensorfault.monitor.statistic.averaged_freed import AveragedFreed
from sensorfault.monitor.statistic.averaged_innovation import AveragedInnovation
from sensorfault.monitor.statistic.averaged_together import AveragedTogether
from sensorfault.monitor.statistic.cumulative_bank import CumulativeBank
from sensorfault.monitor.statistic.cusum import Cusum
from sensorfault.monitor.statistic.deficit import Deficit
from sensorfault.monitor.statistic.double_threshold import DoubleThreshold
from sensorfault.monitor.statistic.ewma import Ewma
from sensorfault.monitor.statistic.exchange import Exchange
from sensorfault.monitor.statistic.freed import Freed
from sensorfault.monitor.statistic.fuzzy_inference import FuzzyInference
from sensorfault.monitor.statistic.horizons import Horizons
from sensorfault.monitor.statistic.lasting import Lasting
from sensorfault.monitor.statistic.late import Late
from sensorfault.monitor.statistic.logistic_regression import LogisticRegression
from sensorfault.monitor.statistic.mahalanobis import Mahalanobis
from sensorfault.monitor.statistic.mean_pair import MeanPair
from sensorfault.monitor.statistic.means import Means
from sensorfault.monitor.statistic.norm import Norm
from sensorfault.monitor.statistic.normalised import Normalised
from sensorfault.monitor.statistic.normality import Normality
from sensorfault.monitor.statistic.of import Of
from sensorfault.monitor.statistic.outlier_factor import OutlierFactor
from sensorfault.monitor.statistic.ramp_glr import RampGlr
from sensorfault.monitor.statistic.relative import Relative
from sensorfault.monitor.statistic.repeats import Repeats
from sensorfault.monitor.statistic.shortfall import Shortfall
from sensorfault.monitor.statistic.slippage import Slippage
from sensorfault.monitor.statistic.slope import Slope
from sensorfault.monitor.statistic.standardised import Standardised
from sensorfault.monitor.statistic.standing import Standing
from sensorfault.monitor.statistic.whitened import Whitened
from sensorfault.monitor.statistic.windowed import Windowed
from sensorfault.monitor.statistic.windowed_chi_square import WindowedChiSquare
from sensorfault.monitor.statistic.windowed_outlier_factor import WindowedOutlierFactor
from sensorfault.monitor.threshold.adaptive import Adaptive
from sensorfault.monitor.threshold.chi_square import ChiSquare
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.monitor.threshold.scaled_max import ScaledMax
from sensorfault.monitor.threshold.sigma import Sigma
from sensorfault.numerics.fuzzy import Anfis, Premises
from sensorfault.numerics.logistic import Logistic
from sensorfault.numerics.networks.dense import Dense, Linear, Mlp
from sensorfault.numerics.networks.lstm import Lstm, LstmLayer
from sensorfault.numerics.outlier_factor import LocalDensity
from sensorfault.numerics.unit_range import UnitRange
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
