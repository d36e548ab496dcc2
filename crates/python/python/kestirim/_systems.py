"""The five systems: each call takes a recording and returns the estimates."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _kestirim
from ._check import Floats, finite, floats, ints, maybe_floats
from ._kestirim import KestirimError
from ._results import FlightTrack, ImuLog, ReceiverTrack, SmoothedTag, Strides, TagTrack, UserTrack, Walk

Scalar = Literal["f32", "f64", "fixed"]


Path = Union[str, "os.PathLike[str]"]


def read_imu(
    path: Path,
    *,
    columns: Optional[str] = None,
    units: Optional[str] = None,
    format: Optional[str] = None,
    topic: Optional[str] = None,
    strict: bool = False,
) -> ImuLog:
    """Reads a log of an inertial sensor: text of any device, ArduPilot, PX4, a ROS 1 bag, MCAP, or a phone's export.

    Columns, units and axes are recognised and reported; a log that is ambiguous is refused with a hint which argument
    to give. columns: such as "t=time,gy=-GyrZ". units: such as "acc=g,gyro=deg/s,t=ms". format: name of the format.
    topic: that of one sensor among several. Damaged lines are skipped and reported; strict: they refuse the log.

    >>> log = read_imu("walk.csv")  # doctest: +SKIP
    >>> walk = pedestrian(log.t, log.accel, log.gyro, mag=log.mag)  # doctest: +SKIP

    Equals what `host-sim replay pedestrian --log` reads, with the findings of `host-sim check pedestrian`.
    """
    return ImuLog(**_kestirim.read_imu(os.fspath(path), columns, units, format, topic, strict))


def pedestrian(
    t: npt.ArrayLike,
    accel: npt.ArrayLike,
    gyro: npt.ArrayLike,
    sensor: Literal["industrial", "consumer"] = "industrial",
    *,
    mag: Optional[npt.ArrayLike] = None,
    causal: bool = False,
    tracker: Literal["ekf", "lite"] = "ekf",
    contact_height: Optional[float] = None,
    scalar: Scalar = "f32",
) -> Walk:
    """Estimates the path of a walking foot, from an IMU on it.

    t: (n,) s, from 0 on. accel: (n, 3) m/s², specific force in the sensor's axes: +9.8 upwards at rest.
    gyro: (n, 3) rad/s, in the sensor's axes.

    mag: (n, 3) magnetic field in any unit, in the sensor's axes, NaN where it was not measured: corrects the heading
    where the foot stands twice in the same field. It is used only if `causal` is False and `tracker` is "ekf".

    sensor: "industrial" for calibrated units (Xsens, NGIMU, 3DM-GX), whose gyroscope starts within 3 mrad/s of zero;
    "consumer" for bare chips (MPU-6050, the Razor).
    causal: use past samples only, as firmware must; by default every estimate uses the whole recording.
    tracker: "ekf", an error-state Kalman filter, or "lite", the paper's architecture.
    contact_height: m, height of the sensor above the ball of the foot, about which the foot rolls; 0.07 by default.
    scalar: number type of the estimator.

    Equals `host-sim replay pedestrian --sensor …`, to the bit.
    """
    times = floats("t", t, "n")
    count = len(times)
    results = _kestirim.pedestrian(
        times,
        floats("accel", accel, count, 3),
        floats("gyro", gyro, count, 3),
        maybe_floats("mag", mag, count, 3),
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
        heading_rate=results["heading_rate"],
        warnings=results["warnings"],
        reasons=results["reasons"],
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
    smooth: bool = False,
) -> TagTrack:
    """Estimates the track of a tag, from ranges to ultra-wideband anchors.

    anchors: (a, 3) m, positions in the room frame, right-handed with z up. t: (n,) s. anchor: (n,) row in `anchors` of
    each range. range: (n,) m, NaN where none was received.

    height: m, of the tag, in the plane; or heights: times (k,) s and heights (k,) m. With neither, the height is
    determined from the ranges, if they allow it.
    biases: (a,) m by which each anchor measures too long, if the anchors are calibrated.
    imu: times (k,) s and accelerations (k, 3) m/s², body axes, with or without gravity: distinguishes standing from
    moving.
    wheels: times (k,) s, speeds (k,) m/s and turn rates (k,) rad/s.
    room: x0, y0, x1, y1, m: two opposite corners of the room that the tag is in.
    dim: 2 in the plane at a known height, 3 in space.
    smooth: also estimate each position from the measurements before and after it, and the anchors' biases: `smoothed`.

    Equals `host-sim replay robot`, to the bit.
    """
    places = floats("anchors", anchors, "a", 3)
    if len(places) == 0:
        raise KestirimError("anchors: expected at least one")
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
        smooth,
    )
    smoothed = results["smoothed"]
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
        smoothed=None if smoothed is None else _smoothed(results["t"], smoothed),
        not_smoothed=results["not_smoothed"],
        warnings=results["warnings"],
        reasons=results["reasons"],
    )


def _smoothed(t: Floats, found: _kestirim._SmoothedTag) -> SmoothedTag:
    return SmoothedTag(
        t=t,
        position=found["position"],
        sigma=found["sigma"],
        health=found["health"],
        biases=found["biases"],
        common_bias=(found["common_bias"][0], found["common_bias"][1]),
        excess_in_10_m=(found["excess_in_10_m"][0], found["excess_in_10_m"][1]),
    )


def drone(
    t: npt.ArrayLike,
    position: npt.ArrayLike,
    height: npt.ArrayLike,
    *,
    path_loss: Optional[npt.ArrayLike] = None,
    rssi: Optional[npt.ArrayLike] = None,
    heading: Optional[npt.ArrayLike] = None,
    area: Optional[npt.ArrayLike] = None,
    environment: Literal["open", "suburban", "urban", "dense-urban", "high-rise"] = "open",
    frequency: float = 2e9,
    window: Optional[float] = None,
    every: bool = True,
) -> UserTrack:
    """Estimates the place of a drone's user, from path losses or levels alone.

    t: (n,) s. position: (n, 2) m to the east and north, of the drone. height: (n,) m, of the drone above the user.
    path_loss: (n,) dB, or rssi: (n,) dB of unknown offset; exactly one of the two, NaN where nothing was measured.
    heading: (n,) degrees clockwise from north, direction of the drone's nose; NaN where it is not known.

    area: (k, 2) m, corners of the polygon in which the user can be, in order; by default up to 500 m beyond the flight.
    environment: buildings on the ground; "open" for none.
    frequency: Hz, of path losses; the excess of an environment over free space is that at 2e9.
    window: s, only measurements of the last `window` seconds count, for a user who moves; None for all.
    every: estimate after each measurement (over open ground and with a window at most 30 times, evenly distributed);
    False estimates only after the last one (among buildings without a window, it has no effect).

    Equals `host-sim replay drone`, to the bit.
    """
    if (path_loss is None) == (rssi is None):
        raise KestirimError("drone: expected path_loss or rssi, one of the two")
    times = finite("t", t, "n")
    count = len(times)
    name, value = ("path_loss", path_loss) if rssi is None else ("rssi", rssi)
    assert value is not None
    results = _kestirim.drone(
        times,
        floats("position", position, count, 2),
        floats("height", height, count),
        floats(name, value, count),
        maybe_floats("heading", heading, count),
        rssi is not None,
        maybe_floats("area", area, "k", 2),
        None if environment == "open" else environment,
        frequency,
        window,
        every,
    )
    return UserTrack(**results)


@dataclass(frozen=True)
class UavModel:
    """A linear model of an aircraft near its steady flight.

    States: angle of attack α (rad), pitch rate q (rad/s), airspeed V (m/s), pitch angle θ (rad). Inputs: elevator δe
    (rad) and throttle δt (0 to 1).
    """

    a: Floats
    """(4, 4) A of dx/dt = A x + B u, 1/s …; with an `interval`, A of x⁺ = A x + B u."""
    b: Floats
    """(4, 2) B of the same equation as `a`."""
    interval: Optional[float] = None
    """s, interval between steps of a model in discrete time; None for continuous time."""
    trim: Optional[tuple[list[float], list[float]]] = None
    """State (4) and input (2) of the steady flight, which are subtracted from absolute values; None if unknown."""

    @classmethod
    def named(cls, name: Literal["P1", "P2", "P3"]) -> UavModel:
        """The model of a known aircraft: "P1" the Aerosonde, "P2" the thesis' own as stated there, "P3" the Navion."""
        found = _kestirim.uav_model(name)
        return cls(found["a"], found["b"], trim=found["trim"])


_STATES = ("alpha", "q", "V", "theta")


def uav(
    t: npt.ArrayLike,
    inputs: npt.ArrayLike,
    measured: npt.ArrayLike,
    outputs: Union[Sequence[str], npt.ArrayLike] = _STATES,
    *,
    model: Union[Literal["P1", "P2", "P3"], UavModel] = "P2",
    absolute: bool = False,
    estimator: Literal["kalman", "luenberger"] = "kalman",
    poles: Sequence[complex] = (-3.0, -3.5, -4.0, -4.5),
    input_noise: Optional[tuple[float, float]] = None,
    output_noise: Optional[npt.ArrayLike] = None,
    ratio: float = 1.0,
    scalar: Scalar = "f64",
) -> FlightTrack:
    """Estimates angle of attack, pitch rate, airspeed and pitch angle of an aircraft, from some sensors, with gaps.

    t: (n,) s, at a regular interval. inputs: (n, 2) elevator (rad) and throttle (0 to 1). measured: (n, p), NaN where
    nothing was measured. outputs: the measured states, of "alpha", "q", "V", "theta"; or the matrix C itself, (p, 4).

    model: of the aircraft. absolute: values are absolute, and the model's trim is subtracted; by default, deviations.
    estimator: a Kalman filter, or a Luenberger observer with these `poles` in 1/s.
    input_noise, output_noise: standard deviations of the noise on the inputs, per sample, and of the outputs (p,); by
    default those of usual sensors. ratio: Q/R of the filter, relative to that of the noise.

    Equals `host-sim replay uav`, to the bit.
    """
    aircraft = model if isinstance(model, UavModel) else UavModel.named(model)
    if absolute and aircraft.trim is None:
        raise KestirimError("absolute: expected a model with a trim, P1 or one that has it")
    rows = _rows(outputs)
    times = finite("t", t, "n")
    count = len(times)
    results = _kestirim.uav(
        times,
        floats("inputs", inputs, count, 2),
        floats("measured", measured, count, len(rows)),
        floats("model.a", aircraft.a, 4, 4),
        floats("model.b", aircraft.b, 4, 2),
        rows,
        aircraft.interval,
        aircraft.trim if absolute else None,
        estimator,
        [(complex(pole).real, complex(pole).imag) for pole in poles],
        input_noise,
        maybe_floats("output_noise", output_noise, len(rows)),
        ratio,
        scalar,
    )
    return FlightTrack(**results)


def _rows(outputs: Union[Sequence[str], npt.ArrayLike]) -> Floats:
    if isinstance(outputs, (list, tuple)) and outputs and isinstance(outputs[0], str):
        unknown = [name for name in outputs if name not in _STATES]
        if unknown:
            raise KestirimError(f"outputs: expected names of {', '.join(_STATES)}, found {unknown[0]!r}")
        return np.eye(4)[[_STATES.index(name) for name in outputs]]
    return floats("outputs", outputs, "p", 4)


def gnss(
    obs: Path,
    sp3: Union[Path, Sequence[Path]] = (),
    antex: Union[Path, Sequence[Path]] = (),
    *,
    nav: Union[Path, Sequence[Path]] = (),
    clk: Union[Path, Sequence[Path]] = (),
    bias: Union[Path, Sequence[Path]] = (),
    blq: Optional[Path] = None,
    erp: Optional[Path] = None,
    process_noise: Optional[float] = None,
    method: Literal["filter", "single"] = "filter",
    filter: Literal["default", "gkf", "rkf", "skf", "ikf", "adaptive"] = "default",
    systems: Literal["all", "gps", "galileo", "gps-galileo"] = "all",
    ambiguities: Literal["float", "fixed"] = "float",
    mask: Optional[float] = None,
    gradient: Optional[float] = None,
    until: Optional[float] = None,
    smooth: bool = False,
) -> ReceiverTrack:
    """Estimates the positions of a receiver of GPS, Galileo, GLONASS and BeiDou, from files; any may be gzipped.

    obs: observations of the receiver, RINEX 2, 3 or 4, Compact RINEX, or a stream of UBX or RTCM.
    For positions to a centimetre: sp3: precise orbits. antex: phase centres of antennas. clk: precise clocks, RINEX; by
    default those of the orbit files.
    For positions to some metres, from GPS, Galileo and BeiDou, without sp3: nav: broadcast ephemerides, RINEX 2, 3 or
    4; a stream contains its own.
    bias: biases of codes and phases, Bias-SINEX. blq: ocean loading of the station. erp: Earth rotation, for the pole
    tide.

    process_noise: m²/s, of a moving receiver: added to each coordinate's variance (100: each epoch stands alone); None
    for a receiver at rest. method: "filter", or "single" for each position from the codes of its epoch alone, for which
    one carrier is enough. filter: treatment of observations that do not fit. systems: systems whose satellites are
    used; "all" for all that are observed and known. ambiguities: "fixed" fixes them to integers where that passes the
    tests, for GPS and Galileo with integer clocks or phase biases. mask: rad, elevation mask, 8° by default. gradient:
    m, standard deviation of the troposphere's gradients (0: none), 0.0005 by default in the default filter. until: s
    since the midnight before the first epoch, the last epoch. smooth: combine the solutions forwards and backwards,
    from the first epoch on.

    Equals `host-sim replay gnss`, to the bit.
    """
    if sp3 and not antex:
        raise KestirimError("antex: expected phase centres of antennas beside precise orbits")
    if smooth and method == "single":
        raise KestirimError("smooth: expected method='filter', whose positions depend on each other")
    results = _kestirim.gnss(
        os.fspath(obs),
        _paths(sp3),
        _paths(antex),
        _paths(nav),
        _paths(clk),
        _paths(bias),
        None if blq is None else os.fspath(blq),
        None if erp is None else os.fspath(erp),
        process_noise,
        method,
        filter,
        systems,
        ambiguities,
        mask,
        gradient,
        until,
        smooth,
    )
    return ReceiverTrack(**results)


def _paths(given: Union[Path, Sequence[Path]]) -> list[str]:
    paths = (given,) if isinstance(given, (str, os.PathLike)) else given
    return [os.fspath(path) for path in paths]


def _over_time(
    name: str, value: Optional[tuple[npt.ArrayLike, npt.ArrayLike]]
) -> Optional[tuple[Floats, Floats]]:
    if value is None:
        return None
    times = finite(f"{name}, times", value[0], "k")
    if len(times) == 0:
        raise KestirimError(f"{name}, times: expected at least one")
    return times, finite(name, value[1], len(times))


def _imu(
    value: Optional[tuple[npt.ArrayLike, npt.ArrayLike]],
) -> Optional[tuple[Floats, Floats]]:
    if value is None:
        return None
    times = finite("imu, times", value[0], "k")
    return times, floats("imu, accelerations", value[1], len(times), 3)


def _wheels(
    value: Optional[tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike]],
) -> Optional[tuple[Floats, Floats, Floats]]:
    if value is None:
        return None
    times = finite("wheels, times", value[0], "k")
    count = len(times)
    return times, floats("wheels, speeds", value[1], count), floats("wheels, turn rates", value[2], count)
