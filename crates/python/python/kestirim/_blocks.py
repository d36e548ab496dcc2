"""Building blocks: estimators for any sensor, and the design of observers. All compute in double precision."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Optional

import numpy as np
import numpy.typing as npt

from . import _kestirim
from ._check import Complexes, Floats, finite, floats, maybe_floats


def _noise(r: npt.ArrayLike, count: int) -> Floats:
    """R as a matrix, from a matrix or from its diagonal."""
    array = np.asarray(r, dtype=np.float64)
    return finite("R", np.diag(array) if array.ndim == 1 else array, count, count)


@dataclass(frozen=True)
class Filtered:
    """Results of a Kalman filter with k states for n rows of m measurements."""

    x: Floats
    """(n, k) estimated state after each row."""
    P: Floats
    """(n, k, k) covariance of the state after each row."""
    innovation: Floats
    """(n, m) innovation z - H x before the update with each row; NaN where nothing was measured."""
    nis: Floats
    """(n,) normalised innovation squared of each row: on average the number of its measurements."""


@dataclass(frozen=True)
class AdaptivelyFiltered(Filtered):
    """Results of an adaptive Kalman filter, including the variances that it has learnt."""

    R: Floats
    """(n, m) learnt variances of the measurements after each row."""
    Q: Floats
    """(n, k) learnt diagonal of the process noise after each row."""


@dataclass(frozen=True)
class RobustlyFiltered(Filtered):
    """Results of a robust Kalman filter, including the weight of each measurement."""

    weight: Floats
    """(n, m) weight of each measurement, from 0 (rejected) to 1 (fully used); NaN where nothing was measured."""


class _Sleeper:
    """Base class of all blocks with a state."""

    _sleeper: _kestirim.Filter | _kestirim.Cloud | _kestirim.Observer

    def snapshot(self) -> bytes:
        """The complete state as bytes, with a name, version, size and checksum, for example to write it to a file."""
        return self._sleeper.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Continues from a snapshot, bit for bit.

        A snapshot that is damaged, or of another kind or size, is refused, and the object is unchanged. Constructor
        arguments that are not part of the state (F, H, Q and R of a plain or robust filter) are not in the snapshot:
        construct the object with the same ones.
        """
        self._sleeper.restore(snapshot)


class _Filter(_Sleeper):
    """Base class of all Kalman filters."""

    def __init__(
        self,
        x: npt.ArrayLike,
        P: npt.ArrayLike,
        F: npt.ArrayLike,
        H: npt.ArrayLike,
        Q: npt.ArrayLike,
        R: npt.ArrayLike,
        kind: str,
        forgetting: float = 1.0,
        limits: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
        method: str = "",
    ) -> None:
        state = finite("x", x, "k")
        count = len(state)
        rows = finite("H", H, "m", count)
        self._measurements = len(rows)
        self._filter = _kestirim.Filter(
            state,
            finite("P", P, count, count),
            finite("F", F, count, count),
            rows,
            finite("Q", Q, count, count),
            _noise(R, len(rows)),
            kind,
            forgetting,
            limits,
            method,
        )
        self._sleeper = self._filter

    @property
    def x(self) -> Floats:
        """(k,) estimated state."""
        return np.array(self._filter.x())

    @property
    def P(self) -> Floats:
        """(k, k) covariance of the state."""
        flat = np.array(self._filter.p())
        count = int(np.sqrt(len(flat)))
        return flat.reshape(count, count)

    def predict(self) -> None:
        """Predicts by one step: x = F x, P = F P F' + Q."""
        self._filter.predict()

    def update(self, z: npt.ArrayLike) -> float:
        """Updates with measurements (m,), NaN where not measured; returns their normalised innovation squared."""
        return self._filter.update(floats("z", z, self._measurements))

    def correct(self, innovation: npt.ArrayLike, H: npt.ArrayLike) -> float:
        """Updates with innovations z - h(x) (m,) and the Jacobian dh/dx (m, k): the extended Kalman filter.

        The caller linearises the model h. Returns the normalised innovation squared.
        """
        count = len(self._filter.x())
        found = floats("innovation", innovation, self._measurements)
        return self._filter.correct(found, floats("H", H, self._measurements, count))

    def _run(self, zs: npt.ArrayLike) -> _kestirim._Filtered:
        array = np.asarray(zs, dtype=np.float64)
        if array.ndim == 1 and self._measurements == 1:
            array = array[:, np.newaxis]
        return self._filter.filter(floats("zs", array, "n", self._measurements))


class KalmanFilter(_Filter):
    """The Kalman filter of a linear model, with 1 to 12 states and 1 to 12 measurements.

    x: (k,) initial state. P: (k, k) its covariance. F: (k, k) transition of a step. H: (m, k) measurement matrix.
    Q: (k, k) process noise of a step. R: (m, m) measurement noise, or (m,) its diagonal.
    """

    def __init__(
        self,
        x: npt.ArrayLike,
        P: npt.ArrayLike,
        F: npt.ArrayLike,
        H: npt.ArrayLike,
        Q: npt.ArrayLike,
        R: npt.ArrayLike,
    ) -> None:
        super().__init__(x, P, F, H, Q, R, "plain")

    def filter(self, zs: npt.ArrayLike) -> Filtered:
        """Predicts and updates with each row of zs (n, m): with all rows or, if one is refused, with none."""
        found = self._run(zs)
        return Filtered(found["x"], found["P"], found["innovation"], found["nis"])


class AdaptiveKalmanFilter(_Filter):
    """An adaptive extended Kalman filter: learns variances of measurements and states from residuals, within limits.

    Arguments as for `KalmanFilter`; learning starts from the diagonals of Q and R. forgetting: forgetting factor; 0.95
    remembers about 20 rows. r_limits: smallest and largest variance of a measurement. q_limits: smallest and largest
    variance of a state per step.
    """

    def __init__(
        self,
        x: npt.ArrayLike,
        P: npt.ArrayLike,
        F: npt.ArrayLike,
        H: npt.ArrayLike,
        Q: npt.ArrayLike,
        R: npt.ArrayLike,
        *,
        forgetting: float,
        r_limits: tuple[float, float],
        q_limits: tuple[float, float],
    ) -> None:
        super().__init__(x, P, F, H, Q, R, "adaptive", forgetting, (*r_limits, *q_limits))

    def filter(self, zs: npt.ArrayLike) -> AdaptivelyFiltered:
        """Predicts, updates and learns with each row of zs (n, m): with all rows or, if one is refused, with none."""
        found = self._run(zs)
        answer = (found["x"], found["P"], found["innovation"], found["nis"])
        return AdaptivelyFiltered(*answer, R=found["first"], Q=found["second"])


class RobustKalmanFilter(_Filter):
    """A Kalman filter that weights measurements by their residuals: outliers are down-weighted or rejected.

    Arguments as for `KalmanFilter`, with a diagonal R. method: IGG III weights, "iterative-igg3" the worst measurement
    first, "igg3" all at once; "t-test" classifies each measurement; "plain" leaves all weights at 1.
    """

    def __init__(
        self,
        x: npt.ArrayLike,
        P: npt.ArrayLike,
        F: npt.ArrayLike,
        H: npt.ArrayLike,
        Q: npt.ArrayLike,
        R: npt.ArrayLike,
        *,
        method: Literal["iterative-igg3", "igg3", "t-test", "plain"] = "iterative-igg3",
    ) -> None:
        super().__init__(x, P, F, H, Q, R, "robust", method=method)

    def filter(self, zs: npt.ArrayLike) -> RobustlyFiltered:
        """Predicts and updates with each row of zs (n, m): with all rows or, if one is refused, with none."""
        found = self._run(zs)
        answer = (found["x"], found["P"], found["innovation"], found["nis"])
        return RobustlyFiltered(*answer, weight=found["first"])


class ParticleFilter(_Sleeper):
    """A cloud of up to 8192 particles in 1 to 6 coordinates, initially drawn uniformly from a box.

    count: number of particles. low, high: (d,) corners of the box. The same seed draws the same numbers.
    """

    def __init__(self, count: int, low: npt.ArrayLike, high: npt.ArrayLike, *, seed: int = 0) -> None:
        corner = floats("low", low, "d")
        self._size = (count, len(corner))
        self._cloud = _kestirim.Cloud(count, corner, floats("high", high, len(corner)), seed)
        self._sleeper = self._cloud

    @property
    def states(self) -> Floats:
        """(n, d) states of the particles."""
        return np.array(self._cloud.states()).reshape(self._size)

    @property
    def weights(self) -> Floats:
        """(n,) weights of the particles; their sum is 1."""
        return np.array(self._cloud.weights())

    @property
    def effective(self) -> float:
        """Effective number of particles: as many of equal weight would represent the distribution as well."""
        return self._cloud.effective()

    @property
    def mean(self) -> Floats:
        """(d,) weighted mean of the particles."""
        return np.array(self._cloud.moments()[0])

    @property
    def covariance(self) -> Floats:
        """(d, d) weighted covariance of the particles."""
        return np.array(self._cloud.moments()[1]).reshape(self._size[1], self._size[1])

    def move(self, states: npt.ArrayLike) -> None:
        """Replaces the states of the particles (n, d): the prediction, which the caller computes from `states`."""
        self._cloud.move_to(floats("states", states, *self._size))

    def update(self, log_likelihood: npt.ArrayLike) -> float:
        """Updates the weights with log-likelihoods (n,) of the particles; returns the logarithm of the evidence.

        A particle whose log-likelihood is not finite gets no weight.
        """
        return self._cloud.update(floats("log_likelihood", log_likelihood, self._size[0]))[1]

    def resample(
        self, resampler: Literal["systematic", "stratified", "residual", "multinomial"] = "systematic"
    ) -> None:
        """Duplicates heavy particles and drops light ones; afterwards all have the same weight."""
        self._cloud.resample(resampler)

    def jitter(self, deviation: npt.ArrayLike) -> None:
        """Adds nearly normal noise with these standard deviations (d,) to the particles."""
        self._cloud.jitter(floats("deviation", deviation, self._size[1]))

    def regularise(self, scale: float = 1.0) -> None:
        """Adds noise in the shape of the cloud, preserving its mean and covariance (Liu and West)."""
        self._cloud.regularise(scale)


@dataclass(frozen=True)
class Attitude:
    """Attitude and gyroscope bias after each of n samples."""

    quaternion: Floats
    """(n, 4) w, x, y, z: body to earth frame, z up; the heading is from the gyroscope alone."""
    gyro_bias: Floats
    """(n, 3) rad/s: estimated bias of the gyroscope, body frame."""


def attitude(
    t: npt.ArrayLike,
    gyro: npt.ArrayLike,
    accel: Optional[npt.ArrayLike] = None,
    *,
    start: Optional[tuple[float, float, float, float]] = None,
    gyro_bias: tuple[float, float, float] = (0.0, 0.0, 0.0),
    tilt_gain: float = 1.0,
    bias_gain: float = 0.03,
    gate: float = 0.1,
) -> Attitude:
    """Attitude and heading reference: fuses gyroscope and accelerometer in a quaternion (Mahony 2008).

    t: (n,) s. gyro: (n, 3) rad/s, body axes. accel: (n, 3) m/s², specific force, body axes.
    start: initial quaternion w, x, y, z; by default levelled with the first specific force. gyro_bias: initial bias,
    rad/s. tilt_gain: 1/s. bias_gain: 1/s². gate: largest deviation of |accel|/g from 1 at which accel is treated as
    gravity.
    """
    times = floats("t", t, "n")
    count = len(times)
    interval = np.diff(times, prepend=times[:1])
    found = _kestirim.attitude(
        interval,
        floats("gyro", gyro, count, 3),
        maybe_floats("accel", accel, count, 3),
        start,
        gyro_bias,
        tilt_gain,
        bias_gain,
        gate,
    )
    return Attitude(found["quaternion"], found["gyro_bias"])


@dataclass(frozen=True)
class Observed:
    """Results of an observer for n rows."""

    x: Floats
    """(n, k) estimated state at the time of each measurement, before it is used."""
    innovation: Floats
    """(n, p) innovation y - C x."""


class LuenbergerObserver(_Sleeper):
    """A Luenberger observer, x = A x + B u + L (y - C x) per step, of 1 to 8 states, up to 4 inputs and 1 to 4 outputs.

    a: (k, k) A. b: (k, m) B. c: (p, k) C. gain: (k, p) L, from `place` or `dare` (`predictor_gain`).
    x: (k,) initial state.
    """

    def __init__(
        self, a: npt.ArrayLike, b: npt.ArrayLike, c: npt.ArrayLike, gain: npt.ArrayLike, x: npt.ArrayLike
    ) -> None:
        start = floats("x", x, "k")
        count = len(start)
        rows, entries = floats("c", c, "p", count), floats("b", b, count, "m")
        self._sizes = (entries.shape[1], len(rows))
        transition, correction = floats("a", a, count, count), floats("gain", gain, count, len(rows))
        self._observer = _kestirim.Observer(transition, entries, rows, correction, start.tolist())
        self._sleeper = self._observer

    @property
    def x(self) -> Floats:
        """(k,) estimated state at the time of the next measurement."""
        return np.array(self._observer.x())

    def run(self, inputs: npt.ArrayLike, measured: npt.ArrayLike) -> Observed:
        """Processes inputs (n, m) and measurements (n, p), rows of NaN where nothing was measured: all rows or none."""
        rows = floats("inputs", inputs, "n", self._sizes[0])
        outputs = floats("measured", measured, len(rows), self._sizes[1])
        found = self._observer.run(rows, outputs)
        return Observed(found["x"], found["innovation"])


@dataclass(frozen=True)
class Placement:
    """Gain of an observer, and the poles that it places."""

    gain: Floats
    """(k, p) gain L of x = A x + B u + L (y - C x)."""
    poles: Complexes
    """(k,) actual eigenvalues of A - L C, in the order of the requested ones."""


def place(a: npt.ArrayLike, c: npt.ArrayLike, poles: Sequence[complex]) -> Placement:
    """Places the eigenvalues of an observer, A - L C, exactly: a (k, k), c (p, k), up to 6 states and 4 outputs.

    For feedback, place(a.T, b.T, poles).gain.T.
    """
    rows = floats("c", c, "p", "k")
    count = rows.shape[1]
    wanted = [(complex(pole).real, complex(pole).imag) for pole in poles]
    found = _kestirim.place(floats("a", a, count, count), rows, wanted)
    return Placement(found["gain"], np.array([complex(*pole) for pole in found["poles"]]))


@dataclass(frozen=True)
class Riccati:
    """The steady-state Kalman filter."""

    prior: Floats
    """(k, k) covariance of the state before an update."""
    posterior: Floats
    """(k, k) covariance of the state after an update."""
    filter_gain: Floats
    """(k, p) gain K of the update x = x + K (y - C x)."""
    predictor_gain: Floats
    """(k, p) gain A K of the predictor form, for `LuenbergerObserver`."""


def dare(a: npt.ArrayLike, c: npt.ArrayLike, q: npt.ArrayLike, r: npt.ArrayLike) -> Riccati:
    """Solves the discrete algebraic Riccati equation of x = A x + w, y = C x + v.

    a: (k, k) A. c: (p, k) C. q: (k, k) covariance of w. r: (p, p) covariance of v.
    """
    rows = floats("c", c, "p", "k")
    count = rows.shape[1]
    square, noise = floats("a", a, count, count), floats("q", q, count, count)
    found = _kestirim.dare(square, rows, noise, floats("r", r, len(rows), len(rows)))
    return Riccati(found["prior"], found["posterior"], found["filter_gain"], found["predictor_gain"])


@dataclass(frozen=True)
class Discrete:
    """Model in discrete time, x = A x + B u per step."""

    a: Floats
    """(k, k) A."""
    b: Floats
    """(k, m) B."""


def c2d(
    a: npt.ArrayLike, b: npt.ArrayLike, interval: float, method: Literal["zoh", "tustin"] = "zoh"
) -> Discrete:
    """Discretises dx/dt = A x + B u, a (k, k), b (k, m), over `interval` s.

    method: "zoh" holds the inputs over the interval; "tustin" is the trapezoidal rule.
    """
    entries = floats("b", b, "k", "m")
    found = _kestirim.c2d(floats("a", a, len(entries), len(entries)), entries, interval, method)
    return Discrete(found["a"], found["b"])
