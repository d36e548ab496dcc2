"""Interface of the Rust module, private to the package, which passes contiguous arrays of the right shapes."""

from typing import Optional, TypedDict, final

import numpy as np
import numpy.typing as npt
from typing_extensions import Self

_Floats = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.int64]
_Bools = npt.NDArray[np.bool_]
_Codes = npt.NDArray[np.uint8]

__all__ = [
    "Cloud",
    "Filter",
    "KestirimError",
    "Observer",
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
    "uav_model",
]

__version__: str

class KestirimError(ValueError): ...

class _Strides(TypedDict):
    t: _Floats
    position: _Floats
    length: _Floats
    duration: _Floats
    heading_change: _Floats
    sigma: _Floats

class _Walk(TypedDict):
    t: _Floats
    position: _Floats
    velocity: _Floats
    orientation: _Floats
    stance: _Bools
    sigma: _Floats
    health: _Codes
    strides: _Strides
    path_length: float
    closure: float
    heading_rate: Optional[float]
    warnings: tuple[str, ...]
    reasons: tuple[str, ...]

class _ImuLog(TypedDict):
    t: _Floats
    accel: _Floats
    gyro: _Floats
    mag: Optional[_Floats]
    understood: tuple[str, ...]
    warnings: tuple[str, ...]

class _SmoothedTag(TypedDict):
    position: _Floats
    sigma: _Floats
    health: _Codes
    biases: _Floats
    common_bias: list[float]
    excess_in_10_m: list[float]

class _TagTrack(TypedDict):
    t: _Floats
    position: _Floats
    sigma: _Floats
    health: _Codes
    taken: _Bools
    nis: _Floats
    lost: float
    height: Optional[float]
    height_sigma: Optional[float]
    smoothed: Optional[_SmoothedTag]
    not_smoothed: Optional[str]
    warnings: tuple[str, ...]
    reasons: tuple[str, ...]

class _UserTrack(TypedDict):
    t: _Floats
    position: _Floats
    sigma: _Floats
    level: _Floats
    health: _Codes
    measurements: int
    next_waypoint: Optional[tuple[float, float, float, float]]
    warnings: tuple[str, ...]
    reasons: tuple[str, ...]

class _UavModel(TypedDict):
    a: _Floats
    b: _Floats
    trim: Optional[tuple[list[float], list[float]]]

class _FlightTrack(TypedDict):
    t: _Floats
    state: _Floats
    sigma: _Floats
    innovations: _Floats
    rejected: _Ints
    health: _Codes
    warnings: tuple[str, ...]
    reasons: tuple[str, ...]

class _ReceiverTrack(TypedDict):
    t: _Floats
    position: _Floats
    sigma: _Floats
    clock: _Floats
    wet_delay: _Floats
    satellites: _Ints
    converged: _Bools
    health: _Codes
    epochs: int
    fixed_epochs: int
    warnings: tuple[str, ...]
    reasons: tuple[str, ...]

class _Filtered(TypedDict):
    x: _Floats
    P: _Floats
    innovation: _Floats
    nis: _Floats
    first: _Floats
    second: _Floats

class _Attitude(TypedDict):
    quaternion: _Floats
    gyro_bias: _Floats

class _Observed(TypedDict):
    x: _Floats
    innovation: _Floats

class _Placement(TypedDict):
    gain: _Floats
    poles: list[tuple[float, float]]

class _Riccati(TypedDict):
    prior: _Floats
    posterior: _Floats
    filter_gain: _Floats
    predictor_gain: _Floats

class _Discrete(TypedDict):
    a: _Floats
    b: _Floats

@final
class Filter:
    def __new__(
        cls,
        x: _Floats,
        p: _Floats,
        f: _Floats,
        h: _Floats,
        q: _Floats,
        r: _Floats,
        kind: str,
        forgetting: float,
        limits: tuple[float, float, float, float],
        method: str,
    ) -> Self: ...
    def x(self) -> list[float]: ...
    def p(self) -> list[float]: ...
    def predict(self) -> None: ...
    def update(self, z: _Floats) -> float: ...
    def correct(self, innovation: _Floats, h: _Floats) -> float: ...
    def filter(self, zs: _Floats) -> _Filtered: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...

@final
class Cloud:
    def __new__(cls, count: int, low: _Floats, high: _Floats, seed: int) -> Self: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...
    def states(self) -> list[float]: ...
    def weights(self) -> list[float]: ...
    def effective(self) -> float: ...
    def moments(self) -> tuple[list[float], list[float]]: ...
    def move_to(self, states: _Floats) -> None: ...
    def update(self, logs: _Floats) -> tuple[float, float]: ...
    def resample(self, resampler: str) -> None: ...
    def jitter(self, deviation: _Floats) -> None: ...
    def regularise(self, scale: float) -> None: ...

@final
class Observer:
    def __new__(cls, a: _Floats, b: _Floats, c: _Floats, l: _Floats, start: list[float]) -> Self: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...
    def x(self) -> list[float]: ...
    def run(self, us: _Floats, ys: _Floats) -> _Observed: ...

def attitude(
    interval: _Floats,
    gyro: _Floats,
    accel: Optional[_Floats],
    start: Optional[tuple[float, float, float, float]],
    bias: tuple[float, float, float],
    tilt: float,
    bias_gain: float,
    gate: float,
) -> _Attitude: ...
def place(a: _Floats, c: _Floats, poles: list[tuple[float, float]]) -> _Placement: ...
def dare(a: _Floats, c: _Floats, q: _Floats, r: _Floats) -> _Riccati: ...
def c2d(a: _Floats, b: _Floats, interval: float, method: str) -> _Discrete: ...
def read_imu(
    path: str,
    columns: Optional[str],
    units: Optional[str],
    format: Optional[str],
    topic: Optional[str],
    strict: bool,
) -> _ImuLog: ...
def pedestrian(
    t: _Floats,
    accel: _Floats,
    gyro: _Floats,
    mag: Optional[_Floats],
    sensor: str,
    causal: bool,
    tracker: str,
    contact_height: Optional[float],
    scalar: str,
) -> _Walk: ...
def robot(
    anchors: _Floats,
    t: _Floats,
    anchor: _Ints,
    range: _Floats,
    height: Optional[float],
    heights: Optional[tuple[_Floats, _Floats]],
    biases: Optional[_Floats],
    imu: Optional[tuple[_Floats, _Floats]],
    wheels: Optional[tuple[_Floats, _Floats, _Floats]],
    room: Optional[tuple[float, float, float, float]],
    dim: int,
    scalar: str,
    smooth: bool,
) -> _TagTrack: ...
def drone(
    t: _Floats,
    place: _Floats,
    height: _Floats,
    value: _Floats,
    heading: Optional[_Floats],
    levels: bool,
    area: Optional[_Floats],
    environment: Optional[str],
    frequency: float,
    window: Optional[float],
    every: bool,
) -> _UserTrack: ...
def uav_model(name: str) -> _UavModel: ...
def uav(
    t: _Floats,
    inputs: _Floats,
    measured: _Floats,
    a: _Floats,
    b: _Floats,
    c: _Floats,
    interval: Optional[float],
    trim: Optional[tuple[list[float], list[float]]],
    estimator: str,
    poles: list[tuple[float, float]],
    input_noise: Optional[tuple[float, float]],
    output_noise: Optional[_Floats],
    ratio: float,
    scalar: str,
) -> _FlightTrack: ...
def gnss(
    obs: str,
    sp3: list[str],
    antex: list[str],
    nav: list[str],
    clk: list[str],
    bias: list[str],
    blq: Optional[str],
    erp: Optional[str],
    process_noise: Optional[float],
    method: str,
    filter: str,
    systems: str,
    ambiguities: str,
    mask: Optional[float],
    gradient: Optional[float],
    until: Optional[float],
    smooth: bool,
) -> _ReceiverTrack: ...
