"""Results of the systems: frozen dataclasses of arrays."""

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
    """Degree to which an estimate can be relied upon: the values of a result's ``health``."""

    GOOD = 0
    """The estimate is as good as its standard deviation says."""
    DEGRADED = 1
    """The estimate is worse than with better data; its stated accuracy still holds approximately."""
    BAD = 2
    """The estimate may be wrong by far more than its stated accuracy."""


_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Frame:
    """Base class of results with one row per sample."""

    t: Floats
    """(n,) s: time of each row."""

    def to_dataframe(self) -> pd.DataFrame:
        """The arrays with one row per sample, as columns (``position_x`` …) of a data frame; needs pandas."""
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
    """The m strides of a walk; `t` is the end of the stance at which each arrived."""

    position: Floats
    """(m, 3) m: position of that stance, earth frame."""
    length: Floats
    """(m,) m: horizontal distance from the preceding stance."""
    duration: Floats
    """(m,) s: time since the end of the preceding stance."""
    heading_change: Floats
    """(m,) rad: change of direction from the preceding stride, anticlockwise from above."""
    sigma: Floats
    """(m, 3) m: standard deviations of the position."""

    def __len__(self) -> int:
        return len(self.t)


@dataclass(frozen=True)
class Walk(Frame):
    """The path of a walking foot: n samples. The earth frame has z up; its origin is where the foot first stood."""

    position: Floats
    """(n, 3) m: position of the sensor, earth frame."""
    velocity: Floats
    """(n, 3) m/s: velocity of the sensor, earth frame."""
    orientation: Floats = dataclasses.field(metadata=_axes("w", "x", "y", "z"))
    """(n, 4) quaternion w, x, y, z: orientation of the sensor, from the body to the earth frame."""
    stance: Bools
    """(n,) whether the foot stands at each sample."""
    sigma: Floats
    """(n, 3) m: standard deviations of the position, as after the preceding stride."""
    health: Codes
    """(n,) reliability of each estimate: values of `Health`."""
    strides: Strides
    """The strides of the walk."""
    path_length: float
    """m: length of the horizontal path, from stance to stance."""
    closure: float
    """m: horizontal distance from start to end."""
    heading_rate: Optional[float]
    """rad/s: drift of the heading that the magnetometer showed and the path was corrected for; None without it."""
    warnings: tuple[str, ...]
    """Findings in the log and the walk that impair an estimate: a sentence each."""
    reasons: tuple[str, ...]
    """Why the walk is not good, in words; empty if it is."""


@dataclass(frozen=True)
class ImuLog(Frame):
    """A log of an inertial sensor: n samples, in the sensor's axes."""

    accel: Floats
    """(n, 3) m/s²: specific force, +9.8 upwards at rest."""
    gyro: Floats
    """(n, 3) rad/s: angular rate."""
    mag: Optional[Floats]
    """(n, 3) magnetic field in the log's unit, NaN where it was not measured; None if the log has no magnetometer."""
    understood: tuple[str, ...]
    """How the columns and units of the log were interpreted, and for what reason: a sentence each."""
    warnings: tuple[str, ...]
    """Damage that was skipped, and findings in the rest that impair the estimate of a walk: a sentence each."""


@dataclass(frozen=True)
class SmoothedTag(Frame):
    """Smoothed positions of a tag, from the measurements before and after, at the m times of its track; biases of its a
    anchors."""

    position: Floats
    """(m, 3) m, room."""
    sigma: Floats
    """(m, 3) m: standard deviations of the position; NaN where there is none (z in the plane)."""
    health: Codes
    """(m,) reliability of each estimate: values of `Health`."""
    biases: Floats = dataclasses.field(metadata={"rows": False})
    """(a, 2) m: bias of each anchor beyond the common bias and what was known, and its standard deviation."""
    common_bias: tuple[float, float]
    """m: bias common to the ranges of all anchors, and its standard deviation."""
    excess_in_10_m: tuple[float, float]
    """m: increase of the common bias over 10 m of distance, and its standard deviation."""


@dataclass(frozen=True)
class TagTrack(Frame):
    """The track of a tag: m times at which there were ranges, from n ranges."""

    position: Floats
    """(m, 3) m: position of the tag, room frame; NaN while it is not known."""
    sigma: Floats
    """(m, 3) m: standard deviations of the position; NaN where the tracker has none (z in the plane)."""
    health: Codes
    """(m,) reliability of each estimate: values of `Health`."""
    taken: Bools = dataclasses.field(metadata={"rows": False})
    """(n,) whether each range was used."""
    nis: Floats = dataclasses.field(metadata={"rows": False})
    """(n,) normalised innovation squared of each range; NaN where it was not compared with an estimate."""
    lost: float
    """s: time without a position after the first range."""
    height: Optional[float]
    """m: height of the tag as determined from the ranges; None if it was given."""
    height_sigma: Optional[float]
    """m: standard deviation of `height`."""
    smoothed: Optional[SmoothedTag]
    """The smoothed track, if it was requested and nothing in `not_smoothed` prevents it."""
    not_smoothed: Optional[str]
    """Why the track is not smoothed, in words, if that was requested."""
    warnings: tuple[str, ...]
    """Findings in the log that impair a track, and changes that were made to the log: a sentence each."""
    reasons: tuple[str, ...]
    """Why the track is not good, in words; empty if it is."""


@dataclass(frozen=True)
class UserTrack(Frame):
    """Estimated places of a drone's user: m estimates, each after a measurement, or one after the last."""

    position: Floats
    """(m, 2) m: place of the user, in the coordinates of the drone's positions."""
    sigma: Floats
    """(m,) m: expected root mean square error of the place."""
    level: Floats
    """(m,) dB: level of the transmitter (over open ground: received at one metre); NaN if losses were measured."""
    health: Codes
    """(m,) reliability of each estimate: values of `Health`."""
    measurements: int
    """Number of measurements that were used."""
    next_waypoint: Optional[tuple[float, float, float, float]]
    """Place where one more measurement is expected to be most informative: x, y, height (m), and the expected sigma (m)
    after it; None among buildings."""
    warnings: tuple[str, ...]
    """Findings in the flight that impair an estimate: a sentence each."""
    reasons: tuple[str, ...]
    """Why the last estimate is not good, in words; empty if it is."""


@dataclass(frozen=True)
class FlightTrack(Frame):
    """Longitudinal motion of an aircraft: n samples."""

    state: Floats = dataclasses.field(metadata=_axes("alpha", "q", "V", "theta"))
    """(n, 4) angle of attack (rad), pitch rate (rad/s), airspeed (m/s), pitch angle (rad)."""
    sigma: Floats = dataclasses.field(metadata=_axes("alpha", "q", "V", "theta"))
    """(n, 4) standard deviations of the state; NaN for an observer, which has none."""
    innovations: Floats = dataclasses.field(metadata=_axes())
    """(n, p) innovations, measured minus expected, in the outputs' units; NaN where nothing was measured."""
    rejected: Ints = dataclasses.field(metadata={"rows": False})
    """(p,) number of measurements of each output that were rejected for contradicting the estimate."""
    health: Codes
    """(n,) reliability of each estimate: values of `Health`."""
    warnings: tuple[str, ...]
    """Findings in the log that impair an estimate, and contradictions to the model: a sentence each."""
    reasons: tuple[str, ...]
    """Why not all of the flight's estimates are good, in words; empty if they are."""


@dataclass(frozen=True)
class ReceiverTrack(Frame):
    """Positions of a receiver: m epochs with a solution; `t` counts from the midnight before the first epoch."""

    position: Floats
    """(m, 3) m: position of the marker, ECEF, free of tides."""
    sigma: Floats = dataclasses.field(metadata=_axes("east", "north", "up"))
    """(m, 3) m: standard deviations of the position to the east, north and up."""
    clock: Floats
    """(m,) m: the receiver's clock minus GPS time."""
    wet_delay: Floats
    """(m,) m: wet zenith delay of the troposphere."""
    satellites: Ints
    """(m,) number of satellites in each solution."""
    converged: Bools
    """(m,) whether the ambiguities are known: the standard deviation of the position is below 10 cm."""
    health: Codes
    """(m,) reliability of each estimate: values of `Health`."""
    epochs: int
    """Number of epochs, with and without a solution."""
    fixed_epochs: int
    """Number of epochs with ambiguities fixed to integers."""
    warnings: tuple[str, ...]
    """Suspicious findings in the files and the solutions: a sentence each."""
    reasons: tuple[str, ...]
    """Why not all of the positions are good, in words; empty if they are."""
