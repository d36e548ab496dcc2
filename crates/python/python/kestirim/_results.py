"""What the systems answer: frozen dataclasses of arrays."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from ._check import Bools, Codes, Floats

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


_AXES: dict[int, tuple[str, ...]] = {2: ("x", "y"), 3: ("x", "y", "z"), 4: ("w", "x", "y", "z")}


def _columns(result: object, names: tuple[str, ...]) -> dict[str, npt.NDArray[Any]]:
    columns: dict[str, npt.NDArray[Any]] = {}
    for name in names:
        value: npt.NDArray[Any] = getattr(result, name)
        if value.ndim == 1:
            columns[name] = value
        else:
            for axis, letter in enumerate(_AXES[value.shape[1]]):
                columns[f"{name}_{letter}"] = value[:, axis]
    return columns


class Frame:
    """What has a row a sample."""

    def to_dataframe(self) -> pd.DataFrame:
        """All arrays with a row a sample as columns (``position_x`` …); needs pandas."""
        import pandas

        names = tuple(
            field.name
            for field in dataclasses.fields(self)  # type: ignore[arg-type]
            if isinstance(getattr(self, field.name), np.ndarray)
            and len(getattr(self, field.name)) == len(getattr(self, "t"))
            and field.metadata.get("rows", True)
        )
        return pandas.DataFrame(_columns(self, names))


@dataclass(frozen=True)
class Strides(Frame):
    """The strides of a walk, m of them."""

    t: Floats
    """(m,) s: end of the stance that each arrived at."""
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

    t: Floats
    """(n,) s."""
    position: Floats
    """(n, 3) m, earth."""
    velocity: Floats
    """(n, 3) m/s, earth."""
    orientation: Floats
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
    reasons: tuple[str, ...]
    """Why the walk is not good, in words; empty if it is."""


@dataclass(frozen=True)
class TagTrack(Frame):
    """Where a tag was: m times at which there were ranges, of n ranges."""

    t: Floats
    """(m,) s."""
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
    reasons: tuple[str, ...]
    """Why the track is not good, in words; empty if it is."""
