"""The five systems: a recording in, what was estimated out."""

from __future__ import annotations

from typing import Literal, Optional

import numpy.typing as npt

from . import _kestirim
from ._check import floats, ints, maybe_floats
from ._kestirim import KestirimError
from ._results import Strides, TagTrack, Walk

Scalar = Literal["f32", "f64", "fixed"]


def pedestrian(
    t: npt.ArrayLike,
    accel: npt.ArrayLike,
    gyro: npt.ArrayLike,
    sensor: Literal["industrial", "consumer"] = "industrial",
    *,
    causal: bool = False,
    tracker: Literal["ekf", "lite"] = "ekf",
    contact_height: Optional[float] = None,
    scalar: Scalar = "f32",
) -> Walk:
    """Where a foot walked, from an IMU on it.

    t: (n,) s, from 0 on. accel: (n, 3) m/s², specific force in the sensor's axes: +9.8 upwards at rest.
    gyro: (n, 3) rad/s, the same axes.

    sensor: "industrial" for calibrated units (Xsens, NGIMU, 3DM-GX), whose gyroscope starts within 3 mrad/s of zero;
    "consumer" for bare chips (MPU-6050, the Razor).
    causal: look only backwards, as firmware must; else the whole recording serves every sample.
    tracker: "ekf", an error-state Kalman filter, or "lite", the paper's architecture.
    contact_height: m from the ball of the foot, about which it rolls, up to the sensor; 0.07 unless it is said.
    scalar: the number type of the estimator.

    The same as `host-sim replay pedestrian --sensor … --no-magnetometer`, to the bit.
    """
    times = floats("t", t, "n")
    count = len(times)
    results = _kestirim.pedestrian(
        times,
        floats("accel", accel, count, 3),
        floats("gyro", gyro, count, 3),
        sensor,
        causal,
        tracker,
        contact_height,
        scalar,
    )
    return Walk(
        t=results["t"],
        position=results["position"],
        velocity=results["velocity"],
        orientation=results["orientation"],
        stance=results["stance"],
        sigma=results["sigma"],
        health=results["health"],
        strides=Strides(**results["strides"]),
        path_length=results["path_length"],
        closure=results["closure"],
        reasons=tuple(results["reasons"]),
    )


def robot(
    anchors: npt.ArrayLike,
    t: npt.ArrayLike,
    anchor: npt.ArrayLike,
    range: npt.ArrayLike,
    *,
    height: Optional[float] = None,
    heights: Optional[tuple[npt.ArrayLike, npt.ArrayLike]] = None,
    biases: Optional[npt.ArrayLike] = None,
    imu: Optional[tuple[npt.ArrayLike, npt.ArrayLike]] = None,
    wheels: Optional[tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike]] = None,
    room: Optional[tuple[float, float, float, float]] = None,
    dim: Literal[2, 3] = 2,
    scalar: Scalar = "f32",
) -> TagTrack:
    """Where a tag was, from ranges to ultra-wideband anchors.

    anchors: (a, 3) m, room: right-handed with z up. t: (n,) s. anchor: (n,) rows of `anchors`. range: (n,) m; not a number
    where none came.

    height: m, of the tag, in the plane; or heights: times (k,) s and heights (k,) m. Of neither the ranges tell it, if
    they can.
    biases: (a,) m that each anchor measures too long, if they are calibrated.
    imu: times (k,) s and accelerations (k, 3) m/s², body, with or without gravity: tells standing from moving.
    wheels: times (k,) s, speeds (k,) m/s and turn rates (k,) rad/s.
    room: x0, y0, x1, y1, m: two opposite corners in which the tag is.
    dim: 2 in the plane at a known height, 3 in space.

    The same as `host-sim replay robot`, to the bit.
    """
    places = floats("anchors", anchors, "a", 3)
    times = floats("t", t, "n")
    count = len(times)
    if height is not None and heights is not None:
        raise KestirimError("height: expected one height or heights over time, found both")
    results = _kestirim.robot(
        places,
        times,
        ints("anchor", anchor, count),
        floats("range", range, count),
        height,
        _over_time("heights", heights),
        maybe_floats("biases", biases, len(places)),
        _imu(imu),
        _wheels(wheels),
        room,
        dim,
        scalar,
    )
    return TagTrack(
        t=results["t"],
        position=results["position"],
        sigma=results["sigma"],
        health=results["health"],
        taken=results["taken"],
        nis=results["nis"],
        lost=results["lost"],
        height=results["height"],
        height_sigma=results["height_sigma"],
        reasons=tuple(results["reasons"]),
    )


def _over_time(
    name: str, value: Optional[tuple[npt.ArrayLike, npt.ArrayLike]]
) -> Optional[tuple[_kestirim.Floats, _kestirim.Floats]]:
    if value is None:
        return None
    times = floats(f"{name}, times", value[0], "k")
    return times, floats(f"{name}", value[1], len(times))


def _imu(
    value: Optional[tuple[npt.ArrayLike, npt.ArrayLike]],
) -> Optional[tuple[_kestirim.Floats, _kestirim.Floats]]:
    if value is None:
        return None
    times = floats("imu, times", value[0], "k")
    return times, floats("imu, accelerations", value[1], len(times), 3)


def _wheels(
    value: Optional[tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike]],
) -> Optional[tuple[_kestirim.Floats, _kestirim.Floats, _kestirim.Floats]]:
    if value is None:
        return None
    times = floats("wheels, times", value[0], "k")
    count = len(times)
    return times, floats("wheels, speeds", value[1], count), floats("wheels, turn rates", value[2], count)
