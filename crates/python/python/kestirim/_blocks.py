"""Building blocks: estimators of any sensor, and the design of observers. All compute in double precision."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Optional

import numpy as np
import numpy.typing as npt

from . import _kestirim
from ._check import Complexes, Floats, floats, maybe_floats


def _noise(r: npt.ArrayLike, count: int) -> Floats:
    """R as a matrix; a line holds its diagonal."""
    array = np.asarray(r, dtype=np.float64)
    return floats("R", np.diag(array) if array.ndim == 1 else array, count, count)


@dataclass(frozen=True)
class Filtered:
    """What a Kalman filter made of n rows of m measurements, with k states."""

    x: Floats
    """(n, k) the state after each row."""
    P: Floats
    """(n, k, k) its covariance."""
    innovation: Floats
    """(n, m) z - H x before each row; not a number where nothing was measured."""
    nis: Floats
    """(n,) normalised innovations squared: as many as there are measurements, on average."""


@dataclass(frozen=True)
class AdaptivelyFiltered(Filtered):
    """The same with what was learnt."""

    R: Floats
    """(n, m) the variances of the measurements after each row."""
    Q: Floats
    """(n, k) the diagonal of the process noise."""


@dataclass(frozen=True)
class RobustlyFiltered(Filtered):
    """The same with what became of each measurement."""

    weight: Floats
    """(n, m) from 0, left out, to 1, fully taken in; not a number where nothing was measured."""


class _Sleeper:
    """What all blocks with a state have."""

    _sleeper: _kestirim.Filter | _kestirim.Cloud | _kestirim.Observer

    def snapshot(self) -> bytes:
        """The whole state, to be written to a file: with its name, version, size and checksum."""
        return self._sleeper.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Goes on from a snapshot to the bit. A torn one, and one of another kind or size, is refused: all stays as it was.

        What was said when the object was made (F, H, Q and R of a plain or robust filter) is not in it: make it alike.
        """
        self._sleeper.restore(snapshot)


class _Filter(_Sleeper):
    """What all Kalman filters have."""

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
        state = floats("x", x, "k")
        count = len(state)
        rows = floats("H", H, "m", count)
        self._measurements = len(rows)
        self._filter = _kestirim.Filter(
            state,
            floats("P", P, count, count),
            floats("F", F, count, count),
            rows,
            floats("Q", Q, count, count),
            _noise(R, len(rows)),
            kind,
            forgetting,
            limits,
            method,
        )
        self._sleeper = self._filter

    @property
    def x(self) -> Floats:
        """(k,) the state."""
        return np.array(self._filter.x())

    @property
    def P(self) -> Floats:
        """(k, k) its covariance."""
        flat = np.array(self._filter.p())
        count = int(np.sqrt(len(flat)))
        return flat.reshape(count, count)

    def predict(self) -> None:
        """Moves on by a step: x = F x, P = F P F' + Q."""
        self._filter.predict()

    def update(self, z: npt.ArrayLike) -> float:
        """Takes in measurements (m,), not a number where nothing was measured; answers with their NIS."""
        return self._filter.update(floats("z", z, self._measurements))

    def correct(self, innovation: npt.ArrayLike, H: npt.ArrayLike) -> float:
        """Takes in innovations z - h(x) (m,) and rows dh/dx (m, k) of a model that you linearised: the extended filter."""
        count = len(self._filter.x())
        found = floats("innovation", innovation, self._measurements)
        return self._filter.correct(found, floats("H", H, self._measurements, count))

    def _run(self, zs: npt.ArrayLike) -> _kestirim._Filtered:
        array = np.asarray(zs, dtype=np.float64)
        if array.ndim == 1 and self._measurements == 1:
            array = array[:, np.newaxis]
        return self._filter.filter(floats("zs", array, "n", self._measurements))


class KalmanFilter(_Filter):
    """The Kalman filter of a linear model, 1 to 12 states and measurements.

    x: (k,). P: (k, k). F: (k, k) of a step. H: (m, k). Q: (k, k) noise of a step. R: (m, m), or (m,) its diagonal.
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
        """Predicts and updates with each row of (n, m); all of them or, if one is refused, none."""
        found = self._run(zs)
        return Filtered(found["x"], found["P"], found["innovation"], found["nis"])


class AdaptiveKalmanFilter(_Filter):
    """The adaptive extended Kalman filter: variances of measurements and states are learnt from residuals, within limits.

    As `KalmanFilter`; the diagonals of Q and R are where learning begins. forgetting: 0.95 remembers about 20 rows.
    r_limits, q_limits: least and greatest variance of a measurement and of a state, a step.
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
        """Predicts, updates and learns with each row of (n, m); all of them or, if one is refused, none."""
        found = self._run(zs)
        answer = (found["x"], found["P"], found["innovation"], found["nis"])
        return AdaptivelyFiltered(*answer, R=found["first"], Q=found["second"])


class RobustKalmanFilter(_Filter):
    """A Kalman filter that weighs measurements by their residuals: outliers are weakened or left out.

    As `KalmanFilter`, with a diagonal R. method: "iterative-igg3" treats the worst measurement first; "igg3" all at once;
    "t-test" classifies; "plain" does nothing.
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
        """Predicts and updates with each row of (n, m); all of them or, if one is refused, none."""
        found = self._run(zs)
        answer = (found["x"], found["P"], found["innovation"], found["nis"])
        return RobustlyFiltered(*answer, weight=found["first"])


class ParticleFilter(_Sleeper):
    """A cloud of up to 8192 particles in 1 to 6 coordinates, evenly spread over a box to begin with.

    low, high: (d,) corners of the box. The same seed draws the same numbers.
    """

    def __init__(self, count: int, low: npt.ArrayLike, high: npt.ArrayLike, *, seed: int = 0) -> None:
        corner = floats("low", low, "d")
        self._size = (count, len(corner))
        self._cloud = _kestirim.Cloud(count, corner, floats("high", high, len(corner)), seed)
        self._sleeper = self._cloud

    @property
    def states(self) -> Floats:
        """(n, d) where the particles are."""
        return np.array(self._cloud.states()).reshape(self._size)

    @property
    def weights(self) -> Floats:
        """(n,) their weights, of which the sum is 1."""
        return np.array(self._cloud.weights())

    @property
    def effective(self) -> float:
        """How many particles of equal weight are worth as much."""
        return self._cloud.effective()

    @property
    def mean(self) -> Floats:
        """(d,) the weighted mean."""
        return np.array(self._cloud.moments()[0])

    @property
    def covariance(self) -> Floats:
        """(d, d) how the particles spread about it."""
        return np.array(self._cloud.moments()[1]).reshape(self._size[1], self._size[1])

    def move(self, states: npt.ArrayLike) -> None:
        """Puts the particles elsewhere, (n, d): the prediction, as you compute it from `states`."""
        self._cloud.move_to(floats("states", states, *self._size))

    def update(self, log_likelihood: npt.ArrayLike) -> float:
        """Takes in log-likelihoods (n,) of the particles; answers with the logarithm of the evidence.

        One that is no finite number leaves its particle no weight.
        """
        return self._cloud.update(floats("log_likelihood", log_likelihood, self._size[0]))[1]

    def resample(
        self, resampler: Literal["systematic", "stratified", "residual", "multinomial"] = "systematic"
    ) -> None:
        """Multiplies heavy particles and drops light ones; then all weigh the same."""
        self._cloud.resample(resampler)

    def jitter(self, deviation: npt.ArrayLike) -> None:
        """Adds nearly normal noise of these standard deviations (d,)."""
        self._cloud.jitter(floats("deviation", deviation, self._size[1]))

    def regularise(self, scale: float = 1.0) -> None:
        """Jitter of the cloud's own shape, which keeps its mean and covariance (Liu and West)."""
        self._cloud.regularise(scale)


@dataclass(frozen=True)
class Attitude:
    """Attitudes after each of n samples."""

    quaternion: Floats
    """(n, 4) w, x, y, z: body to earth, z up; the heading is the gyroscope's alone."""
    gyro_bias: Floats
    """(n, 3) rad/s, body."""


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
    """The attitude and heading reference: gyroscope and accelerometer fused in a quaternion (Mahony 2008).

    t: (n,) s. gyro: (n, 3) rad/s. accel: (n, 3) m/s², specific force; both in body axes.
    start: quaternion w, x, y, z; else level by the first force. tilt_gain: 1/s. bias_gain: 1/s².
    gate: the largest deviation of |accel|/g from 1 at which it is taken for gravity.
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
    """What an observer made of n rows."""

    x: Floats
    """(n, k) the state at the time of each measurement, before it is taken in."""
    innovation: Floats
    """(n, p) y - C x."""


class LuenbergerObserver(_Sleeper):
    """x = A x + B u + L (y - C x) a step, 1 to 8 states, up to 4 inputs and outputs.

    a: (k, k). b: (k, m). c: (p, k). gain: (k, p), as `place` or `dare` answers. x: (k,) the start.
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
        """(k,) the state at the time of the next measurement."""
        return np.array(self._observer.x())

    def run(self, inputs: npt.ArrayLike, measured: npt.ArrayLike) -> Observed:
        """Takes in inputs (n, m) and measurements (n, p), rows of no numbers where nothing was measured; all or none."""
        rows = floats("inputs", inputs, "n", self._sizes[0])
        outputs = floats("measured", measured, len(rows), self._sizes[1])
        found = self._observer.run(rows, outputs)
        return Observed(found["x"], found["innovation"])


@dataclass(frozen=True)
class Placement:
    """A gain of an observer."""

    gain: Floats
    """(k, p) L of x = A x + B u + L (y - C x)."""
    poles: Complexes
    """(k,) the eigenvalues that A - L C really has, in the order in which they were wanted."""


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
    """The Kalman filter that has settled."""

    prior: Floats
    """(k, k) covariance before an update."""
    posterior: Floats
    """(k, k) and after it."""
    filter_gain: Floats
    """(k, p) K of x = x + K (y - C x)."""
    predictor_gain: Floats
    """(k, p) A K, for `LuenbergerObserver`."""


def dare(a: npt.ArrayLike, c: npt.ArrayLike, q: npt.ArrayLike, r: npt.ArrayLike) -> Riccati:
    """Solves the discrete algebraic Riccati equation of x = A x + w, y = C x + v with covariances q (k, k) and r (p, p)."""
    rows = floats("c", c, "p", "k")
    count = rows.shape[1]
    square, noise = floats("a", a, count, count), floats("q", q, count, count)
    found = _kestirim.dare(square, rows, noise, floats("r", r, len(rows), len(rows)))
    return Riccati(found["prior"], found["posterior"], found["filter_gain"], found["predictor_gain"])


@dataclass(frozen=True)
class Discrete:
    """x = A x + B u a step."""

    a: Floats
    """(k, k)."""
    b: Floats
    """(k, m)."""


def c2d(
    a: npt.ArrayLike, b: npt.ArrayLike, interval: float, method: Literal["zoh", "tustin"] = "zoh"
) -> Discrete:
    """Discretises dx/dt = A x + B u, a (k, k), b (k, m), over `interval` s: inputs held, or the trapezoidal rule."""
    entries = floats("b", b, "k", "m")
    found = _kestirim.c2d(floats("a", a, len(entries), len(entries)), entries, interval, method)
    return Discrete(found["a"], found["b"])
