"""Estimators for localisation, written in Rust, over NumPy arrays.

Five systems, each one call a recording: `pedestrian`, `robot`. Units are SI and
radians, frames are named, and an estimate comes with its standard deviation and its `Health`.
"""

from ._kestirim import KestirimError, __version__
from ._results import Health, Strides, TagTrack, Walk
from ._systems import pedestrian, robot

__all__ = [
    "Health",
    "KestirimError",
    "Strides",
    "TagTrack",
    "Walk",
    "__version__",
    "pedestrian",
    "robot",
]
