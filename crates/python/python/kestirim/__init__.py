"""Estimators for localisation, written in Rust, over NumPy arrays.

Five systems, each with one call per recording: `pedestrian`, `robot`, `drone`, `uav`, `gnss`. Units are SI and radians,
frames are named, and every estimate comes with its standard deviation and its `Health`. `read_imu` reads logs of
inertial sensors in many formats. Building blocks: Kalman filters (`KalmanFilter`, `AdaptiveKalmanFilter`,
`RobustKalmanFilter`), `ParticleFilter`, `attitude`, `LuenbergerObserver`, and the design of observers: `place`, `dare`,
`c2d`.

>>> import numpy as np
>>> filter = KalmanFilter(x=[0, 0], P=np.eye(2), F=[[1, 1], [0, 1]], H=[[1, 0]], Q=0.01 * np.eye(2), R=[1])
>>> filter.filter([1.0, 2.0, 3.0]).x.shape
(3, 2)
"""

from ._blocks import (
    AdaptiveKalmanFilter,
    AdaptivelyFiltered,
    Attitude,
    Discrete,
    Filtered,
    KalmanFilter,
    LuenbergerObserver,
    Observed,
    ParticleFilter,
    Placement,
    Riccati,
    RobustKalmanFilter,
    RobustlyFiltered,
    attitude,
    c2d,
    dare,
    place,
)
from ._kestirim import KestirimError, __version__
from ._results import FlightTrack, Health, ImuLog, ReceiverTrack, SmoothedTag, Strides, TagTrack, UserTrack, Walk
from ._systems import UavModel, drone, gnss, pedestrian, read_imu, robot, uav

__all__ = [
    "AdaptiveKalmanFilter",
    "AdaptivelyFiltered",
    "Attitude",
    "Discrete",
    "Filtered",
    "FlightTrack",
    "Health",
    "ImuLog",
    "KalmanFilter",
    "KestirimError",
    "LuenbergerObserver",
    "Observed",
    "ParticleFilter",
    "Placement",
    "ReceiverTrack",
    "Riccati",
    "RobustKalmanFilter",
    "RobustlyFiltered",
    "SmoothedTag",
    "Strides",
    "TagTrack",
    "UavModel",
    "UserTrack",
    "Walk",
    "__version__",
    "attitude",
    "c2d",
    "dare",
    "drone",
    "gnss",
    "pedestrian",
    "place",
    "read_imu",
    "robot",
    "uav",
]
