"""Estimators for localisation, written in Rust, over NumPy arrays.

Five systems, each one call a recording: `pedestrian`, `robot`, `drone`, `uav`, `gnss`. Units are SI and radians, frames
are named, and an estimate comes with its standard deviation and its `Health`.
"""

from ._kestirim import KestirimError, __version__
from ._results import FlightTrack, Health, ReceiverTrack, Strides, TagTrack, UserTrack, Walk
from ._systems import UavModel, drone, gnss, pedestrian, robot, uav

__all__ = [
    "FlightTrack",
    "Health",
    "KestirimError",
    "ReceiverTrack",
    "Strides",
    "TagTrack",
    "UavModel",
    "UserTrack",
    "Walk",
    "__version__",
    "drone",
    "gnss",
    "pedestrian",
    "robot",
    "uav",
]
