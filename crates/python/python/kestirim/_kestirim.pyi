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

class _UserTrack(TypedDict):
    t: Floats
    position: Floats
    sigma: Floats
    level: Floats
    health: Codes
    measurements: int
    reasons: list[str]

class _UavModel(TypedDict):
    a: Floats
    b: Floats
    trim: Optional[tuple[list[float], list[float]]]

class _FlightTrack(TypedDict):
    t: Floats
    state: Floats
    sigma: Floats
    innovations: Floats
    rejected: Ints
    health: Codes
    reasons: list[str]

class _ReceiverTrack(TypedDict):
    t: Floats
    position: Floats
    sigma: Floats
    clock: Floats
    wet_delay: Floats
    satellites: Ints
    converged: Bools
    health: Codes
    epochs: int
    warnings: list[str]
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
def drone(
    t: Floats,
    place: Floats,
    height: Floats,
    value: Floats,
    levels: bool,
    area: Optional[Floats],
    environment: Optional[str],
    every: bool,
) -> _UserTrack: ...
def uav_model(name: str) -> _UavModel: ...
def uav(
    t: Floats,
    inputs: Floats,
    measured: Floats,
    a: Floats,
    b: Floats,
    c: Floats,
    interval: Optional[float],
    trim: Optional[tuple[list[float], list[float]]],
    estimator: str,
    poles: list[tuple[float, float]],
    input_noise: Optional[tuple[float, float]],
    output_noise: Optional[Floats],
    ratio: float,
    scalar: str,
) -> _FlightTrack: ...
def gnss(
    obs: str,
    sp3: list[str],
    antex: list[str],
    clk: list[str],
    bias: list[str],
    blq: Optional[str],
    process_noise: Optional[float],
    filter: str,
    systems: str,
    mask: Optional[float],
    until: Optional[float],
) -> _ReceiverTrack: ...
