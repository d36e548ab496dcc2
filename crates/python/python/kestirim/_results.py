"""What the systems answer: frozen dataclasses of arrays."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from ._check import Bools, Codes, Floats, Ints

if TYPE_CHECKING:
    import pandas as pd


class Health(IntEnum):
    """How far an estimate can be relied upon: the values of a result's ``health``."""

    GOOD = 0
    """As its standard deviation says."""
    DEGRADED = 1
    """Worse than with better data; what is said of its accuracy still holds, more or less."""
    BAD = 2
    """It may be wrong by far more than anything says."""


_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Frame:
    """What has a row a sample."""

    t: Floats
    """(n,) s: of each row."""

    def to_dataframe(self) -> pd.DataFrame:
        """All arrays with a row a sample as columns (``position_x`` …); needs pandas."""
        import pandas

        columns: dict[str, npt.NDArray[Any]] = {}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if not isinstance(value, np.ndarray) or not field.metadata.get("rows", True):
                continue
            if value.ndim == 1:
                columns[field.name] = value
                continue
            axes = field.metadata.get("axes", _AXES)
            for axis in range(value.shape[1]):
                columns[f"{field.name}_{axes[axis] if axis < len(axes) else axis}"] = value[:, axis]
        return pandas.DataFrame(columns)


def _axes(*names: str) -> dict[str, tuple[str, ...]]:
    return {"axes": names}


@dataclass(frozen=True)
class Strides(Frame):
    """The strides of a walk, m of them; `t` is the end of the stance that each arrived at."""

    position: Floats
    """(m, 3) m, earth: where that is."""
    length: Floats
    """(m,) m: horizontal distance from the stance before."""
    duration: Floats
    """(m,) s: time since the end of the stance before."""
    heading_change: Floats
    """(m,) rad: turn from the stride before, anticlockwise from above."""
    sigma: Floats
    """(m, 3) m: standard deviations of the position."""

    def __len__(self) -> int:
        return len(self.t)


@dataclass(frozen=True)
class Walk(Frame):
    """Where a foot walked: n samples. Earth has z up, its origin is where the foot stood first."""

    position: Floats
    """(n, 3) m, earth."""
    velocity: Floats
    """(n, 3) m/s, earth."""
    orientation: Floats = dataclasses.field(metadata=_axes("w", "x", "y", "z"))
    """(n, 4) quaternion w, x, y, z: body to earth."""
    stance: Bools
    """(n,) whether the foot stands."""
    sigma: Floats
    """(n, 3) m: standard deviations of the position, those after the stride before."""
    health: Codes
    """(n,) values of `Health`."""
    strides: Strides
    """The strides."""
    path_length: float
    """m: horizontal, from stance to stance."""
    closure: float
    """m: horizontal distance from start to end."""
    heading_rate: Optional[float]
    """rad/s: at which the heading drifted, as a magnetometer showed it and as the path was corrected by."""
    warnings: tuple[str, ...]
    """What the log and the walk show that harms an estimate: a sentence each."""
    reasons: tuple[str, ...]
    """Why the walk is not good, in words; empty if it is."""


@dataclass(frozen=True)
class ImuLog(Frame):
    """What a log of an inertial sensor says: n samples, in the sensor's axes."""

    accel: Floats
    """(n, 3) m/s², specific force: +9.8 upwards at rest."""
    gyro: Floats
    """(n, 3) rad/s."""
    mag: Optional[Floats]
    """(n, 3) in the log's unit, not a number where it was not measured; None if the log has no magnetometer."""
    understood: tuple[str, ...]
    """How its columns and units were understood, and from what: a sentence each."""
    warnings: tuple[str, ...]
    """What was damaged and left out, and what of the rest harms a walk: a sentence each."""


@dataclass(frozen=True)
class SmoothedTag(Frame):
    """Where a tag was, given what was measured before and after, at the times of its track; and the errors of a anchors."""

    position: Floats
    """(m, 3) m, room."""
    sigma: Floats
    """(m, 3) m: standard deviations; not a number where nothing tells one (z in the plane)."""
    health: Codes
    """(m,) values of `Health`."""
    biases: Floats = dataclasses.field(metadata={"rows": False})
    """(a, 2) m: what each measures too long in addition to all of them and to what was known, and its standard deviation."""
    common_bias: tuple[float, float]
    """m: what all of them measure too long, and its standard deviation."""
    excess_in_10_m: tuple[float, float]
    """m: what more they do in 10 m of distance, and its standard deviation."""


@dataclass(frozen=True)
class TagTrack(Frame):
    """Where a tag was: m times at which there were ranges, of n ranges."""

    position: Floats
    """(m, 3) m, room; not a number while it is not known."""
    sigma: Floats
    """(m, 3) m: standard deviations; not a number where the tracker knows none (z in the plane)."""
    health: Codes
    """(m,) values of `Health`."""
    taken: Bools = dataclasses.field(metadata={"rows": False})
    """(n,) whether each range was taken in."""
    nis: Floats = dataclasses.field(metadata={"rows": False})
    """(n,) normalised innovation squared of each range; not a number where it was not weighed."""
    lost: float
    """s: how long the position was not known after the first range."""
    height: Optional[float]
    """m: the height that the ranges told, if it was not given."""
    height_sigma: Optional[float]
    """m: its standard deviation."""
    smoothed: Optional[SmoothedTag]
    """The same smoothed, if that was asked for and tells more."""
    not_smoothed: Optional[str]
    """Why it is not, in words, if it was asked for and is not."""
    warnings: tuple[str, ...]
    """What the log shows that harms a track, and what was changed of it: a sentence each."""
    reasons: tuple[str, ...]
    """Why the track is not good, in words; empty if it is."""


@dataclass(frozen=True)
class UserTrack(Frame):
    """Where a drone's user was thought to be after each of m measurements, or after the last one alone."""

    position: Floats
    """(m, 2) m, as the drone's places."""
    sigma: Floats
    """(m,) m: root mean square distance from the position that is expected."""
    level: Floats
    """(m,) dB: what the transmitter sends (over open ground: what is received at one metre); not a number where
    losses were measured."""
    health: Codes
    """(m,) values of `Health`."""
    measurements: int
    """How many were used."""
    next_waypoint: Optional[tuple[float, float, float, float]]
    """Where one more measurement is expected to tell most: x, y, height (m), and the sigma (m) that is expected after it; None
    among buildings."""
    warnings: tuple[str, ...]
    """What the flight shows that harms an estimate: a sentence each."""
    reasons: tuple[str, ...]
    """Why the last estimate is not good, in words; empty if it is."""


@dataclass(frozen=True)
class FlightTrack(Frame):
    """How an aircraft flew: n samples."""

    state: Floats = dataclasses.field(metadata=_axes("alpha", "q", "V", "theta"))
    """(n, 4) angle of attack rad, pitch rate rad/s, airspeed m/s, pitch rad."""
    sigma: Floats = dataclasses.field(metadata=_axes("alpha", "q", "V", "theta"))
    """(n, 4) their standard deviations; not a number of an observer, which knows none."""
    innovations: Floats = dataclasses.field(metadata=_axes())
    """(n, p) measured less expected, in the outputs' units; not a number where nothing was measured."""
    rejected: Ints = dataclasses.field(metadata={"rows": False})
    """(p,) how many times each output contradicted the estimate and was left out."""
    health: Codes
    """(n,) values of `Health`."""
    warnings: tuple[str, ...]
    """What the log shows that harms an estimate, and what contradicts the model: a sentence each."""
    reasons: tuple[str, ...]
    """Why not all of it is good, in words; empty if it is."""


@dataclass(frozen=True)
class ReceiverTrack(Frame):
    """Where a receiver was: m epochs with a solution; `t` counts from the midnight before the first one."""

    position: Floats
    """(m, 3) m, ECEF: the marker, free of tides."""
    sigma: Floats = dataclasses.field(metadata=_axes("east", "north", "up"))
    """(m, 3) m: standard deviations to the east, north and up."""
    clock: Floats
    """(m,) m: the receiver's clock minus GPS time."""
    wet_delay: Floats
    """(m,) m: zenith delay of the wet troposphere."""
    satellites: Ints
    """(m,) how many each solution is from."""
    converged: Bools
    """(m,) whether ambiguities are known: the standard deviation is below 10 cm."""
    health: Codes
    """(m,) values of `Health`."""
    epochs: int
    """How many epochs there were."""
    fixed_epochs: int
    """In how many of them some ambiguities were whole."""
    warnings: tuple[str, ...]
    """What the readers found suspicious in the files."""
    reasons: tuple[str, ...]
    """Why not all of it is good, in words; empty if it is."""
