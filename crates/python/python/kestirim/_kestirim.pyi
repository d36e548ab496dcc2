"""What the Rust module offers; arrays are contiguous, of these shapes. Called by the package, not by you."""

from typing import Optional, TypedDict

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]
Codes = npt.NDArray[np.uint8]

__version__: str

class KestirimError(ValueError): ...

class _Strides(TypedDict):
    t: Floats
    position: Floats
    length: Floats
    duration: Floats
    heading_change: Floats
    sigma: Floats

class _Walk(TypedDict):
    t: Floats
    position: Floats
    velocity: Floats
    orientation: Floats
    stance: Bools
    sigma: Floats
    health: Codes
    strides: _Strides
    path_length: float
    closure: float
    reasons: list[str]

class _TagTrack(TypedDict):
    t: Floats
    position: Floats
    sigma: Floats
    health: Codes
    taken: Bools
    nis: Floats
    lost: float
    height: Optional[float]
    height_sigma: Optional[float]
    reasons: list[str]

def pedestrian(
    t: Floats,
    accel: Floats,
    gyro: Floats,
    sensor: str,
    causal: bool,
    tracker: str,
    contact_height: Optional[float],
    scalar: str,
) -> _Walk: ...
def robot(
    anchors: Floats,
    t: Floats,
    anchor: Ints,
    range: Floats,
    height: Optional[float],
    heights: Optional[tuple[Floats, Floats]],
    biases: Optional[Floats],
    imu: Optional[tuple[Floats, Floats]],
    wheels: Optional[tuple[Floats, Floats, Floats]],
    room: Optional[tuple[float, float, float, float]],
    dim: int,
    scalar: str,
) -> _TagTrack: ...
