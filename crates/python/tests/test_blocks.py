"""Building blocks against their textbooks in NumPy."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import pytest

import kestirim

RNG = np.random.default_rng(7)


def textbook(x: Any, P: Any, F: Any, H: Any, Q: Any, R: Any, zs: Any) -> tuple[Any, Any, Any]:
    xs, Ps, nis = [], [], []
    for z in zs:
        x, P = F @ x, F @ P @ F.T + Q
        seen = ~np.isnan(z)
        h, r, y = H[seen], R[np.ix_(seen, seen)], (z - H @ x)[seen]
        S = h @ P @ h.T + r
        K = P @ h.T @ np.linalg.inv(S)
        nis.append(y @ np.linalg.inv(S) @ y)
        x, P = x + K @ y, P - K @ h @ P
        xs.append(x)
        Ps.append(P)
    return np.array(xs), np.array(Ps), np.array(nis)


def model(states: int, measurements: int) -> dict[str, Any]:
    spread = RNG.normal(size=(states, states))
    noise = RNG.normal(size=(measurements, measurements))
    return {
        "x": RNG.normal(size=states),
        "P": np.eye(states) + spread @ spread.T,
        "F": np.eye(states) + 0.05 * RNG.normal(size=(states, states)),
        "H": RNG.normal(size=(measurements, states)),
        "Q": 0.1 * np.eye(states),
        "R": np.eye(measurements) + noise @ noise.T,
    }


@pytest.mark.parametrize(("states", "measurements"), [(1, 1), (4, 2), (6, 6), (12, 3)])
def test_a_kalman_filter_is_the_textbooks(states: int, measurements: int) -> None:
    zs = RNG.normal(size=(50, measurements))
    for diagonal in (False, True):
        of = model(states, measurements)
        if diagonal:
            of["R"] = np.diag(np.diag(of["R"]))
            zs[5:9, 0] = np.nan
        else:
            zs = np.nan_to_num(zs)
        expected = textbook(**of, zs=zs)
        whole, steps = kestirim.KalmanFilter(**of), kestirim.KalmanFilter(**of)
        found = whole.filter(zs)
        for ours, theirs in zip((found.x, found.P, found.nis), expected):
            assert np.allclose(ours, theirs, rtol=1e-8, atol=1e-8)
        assert np.array_equal(np.isnan(found.innovation), np.isnan(zs))
        for row, z in enumerate(zs):
            steps.predict()
            assert steps.update(z) == found.nis[row]
        assert np.array_equal(steps.x, found.x[-1]) and np.array_equal(steps.P, found.P[-1])
        assert np.array_equal(whole.x, steps.x)


def test_an_extended_filter_is_linearised_by_its_caller() -> None:
    of = model(3, 2)
    linear, extended = kestirim.KalmanFilter(**of), kestirim.KalmanFilter(**of)
    z = np.array([0.3, -0.2])
    assert linear.update(z) == pytest.approx(extended.correct(z - of["H"] @ extended.x, of["H"]))
    assert np.allclose(linear.x, extended.x)


def test_what_is_refused_changes_nothing() -> None:
    of = model(2, 1)
    filter = kestirim.KalmanFilter(**of)
    before = filter.x
    with pytest.raises(kestirim.KestirimError, match="sample 3: "):
        filter.filter([0.0, 0.1, 0.2, np.inf])
    assert np.array_equal(filter.x, before)
    for change, sentence in (
        ({"P": np.eye(3)}, r"P: expected an array of shape \(2, 2\), found \(3, 3\)"),
        ({"R": [1.0, 2.0]}, r"R: expected an array of shape \(1, 1\), found \(2, 2\)"),
        ({"H": [[np.nan, 0.0]]}, "H: expected finite numbers, found nan"),
        ({"Q": [[0.0, 0.0], [0.0, np.inf]]}, "Q: expected finite numbers, found inf"),
    ):
        with pytest.raises(kestirim.KestirimError, match=sentence):
            kestirim.KalmanFilter(**{**of, **change})
    with pytest.raises(kestirim.KestirimError, match="expected 1 to 12 states, found 13"):
        kestirim.KalmanFilter(**model(13, 1))
    with pytest.raises(kestirim.KestirimError, match="R: expected a diagonal matrix"):
        kestirim.RobustKalmanFilter(**model(2, 2))


TRACK: dict[str, Any] = {
    "x": [0.0, 1.0],
    "P": np.eye(2),
    "F": [[1.0, 0.1], [0.0, 1.0]],
    "H": [[1.0, 0.0], [1.0, 0.0]],
    "Q": 1e-4 * np.eye(2),
    "R": [0.01, 0.01],
}


def measured(count: int, deviation: float) -> Any:
    truth = 0.1 * np.arange(1, count + 1)
    return truth[:, np.newaxis] + np.random.default_rng(1).normal(size=(count, 2)) * [0.1, deviation]


def test_the_adaptive_filter_learns_which_sensor_is_worse() -> None:
    filter = kestirim.AdaptiveKalmanFilter(
        **TRACK, forgetting=0.98, r_limits=(1e-3, 10.0), q_limits=(1e-6, 1e-3)
    )
    found = filter.filter(measured(800, 1.0))
    assert found.R.shape == (800, 2) and found.Q.shape == (800, 2)
    assert found.R[-1, 0] < 0.05 and 0.3 < found.R[-1, 1] < 3.0
    with pytest.raises(kestirim.KestirimError):
        kestirim.AdaptiveKalmanFilter(**TRACK, forgetting=2.0, r_limits=(0, 1), q_limits=(0, 1))


def test_the_robust_filter_leaves_outliers_out() -> None:
    zs = measured(300, 0.1)
    zs[50::40, 1] += 5.0
    truth = 0.1 * np.arange(1, 301)
    robust = kestirim.RobustKalmanFilter(**TRACK).filter(zs)
    plain = kestirim.KalmanFilter(**TRACK).filter(zs)
    errors = [np.abs(found.x[:, 0] - truth).max() for found in (robust, plain)]
    assert errors[0] < 0.25 and errors[1] > 2 * errors[0], errors
    assert np.all(robust.weight[50::40, 1] == 0.0) and np.mean(robust.weight == 1.0) > 0.9


def test_particles_find_what_a_kalman_filter_finds() -> None:
    cloud = kestirim.ParticleFilter(4000, [-5.0, -5.0], [5.0, 5.0], seed=3)
    assert cloud.states.shape == (4000, 2) and cloud.weights.sum() == pytest.approx(1.0)
    for z in ([1.0, 2.0], [1.2, 1.9]):
        evidence = cloud.update(-0.5 * ((cloud.states - z) ** 2).sum(axis=1) / 0.25)
        assert evidence < 0.0 and cloud.effective < 4000
        cloud.resample()
        cloud.regularise()
    assert np.allclose(cloud.mean, [1.1, 1.95], atol=0.05)
    assert np.allclose(cloud.covariance, 0.125 * np.eye(2), atol=0.03)
    cloud.move(cloud.states + [1.0, 0.0])
    cloud.jitter([0.1, 0.1])
    assert np.allclose(cloud.mean, [2.1, 1.95], atol=0.05)
    same = kestirim.ParticleFilter(4000, [-5.0, -5.0], [5.0, 5.0], seed=3)
    assert np.array_equal(same.states, kestirim.ParticleFilter(4000, [-5.0] * 2, [5.0] * 2, seed=3).states)
    with pytest.raises(kestirim.KestirimError, match="log_likelihood: expected an array of shape"):
        cloud.update([0.0])
    with pytest.raises(kestirim.KestirimError):
        cloud.update(np.full(4000, -np.inf))
    with pytest.raises(kestirim.KestirimError, match="count: expected 1 to 8192 particles, found 9000"):
        kestirim.ParticleFilter(9000, [0.0], [1.0])


def test_an_attitude_is_levelled_and_turns() -> None:
    t = np.arange(2001) / 100
    gyro = np.tile([0.01, 0.0, 0.5], (2001, 1))
    accel = np.tile([0.0, 0.0, 9.80665], (2001, 1))
    found = kestirim.attitude(t, gyro, accel, bias_gain=0.3)
    assert found.gyro_bias[-1, 0] == pytest.approx(0.01, abs=2e-3)
    w, x, y, z = found.quaternion[-1]
    assert np.hypot(x, y) < 0.01
    heading = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    assert np.cos(heading - 0.5 * t[-1]) > 0.999
    with pytest.raises(kestirim.KestirimError, match="sample 1: the interval is negative"):
        kestirim.attitude(t[::-1], gyro)


def test_observers_are_designed_and_run() -> None:
    a, b, c = np.array([[0.0, 1.0], [-2.0, -0.3]]), np.array([[0.0], [1.0]]), np.array([[1.0, 0.0]])
    step = kestirim.c2d(a, b, 0.1)
    assert np.allclose(kestirim.c2d(a, b, 1e-6).a, np.eye(2) + 1e-6 * a)
    assert not np.allclose(kestirim.c2d(a, b, 0.1, "tustin").a, step.a, atol=1e-8)
    wanted = [0.5 + 0.1j, 0.5 - 0.1j]
    placed = kestirim.place(step.a, c, wanted)
    found = np.sort_complex(np.linalg.eigvals(step.a - placed.gain @ c))
    assert np.allclose(found, np.sort_complex(np.array(wanted))) and np.allclose(placed.poles, wanted)

    q, r = 0.01 * np.eye(2), np.array([[0.1]])
    settled = kestirim.dare(step.a, c, q, r)
    filter = kestirim.KalmanFilter([0, 0], np.eye(2), step.a, c, q, r)
    assert np.allclose(filter.filter(np.zeros((500, 1))).P[-1], settled.posterior)
    assert np.allclose(step.a @ settled.filter_gain, settled.predictor_gain)

    observer = kestirim.LuenbergerObserver(step.a, step.b, c, placed.gain, [0.0, 0.0])
    x, inputs, truth = np.array([1.0, -1.0]), np.sin(np.arange(100) / 5)[:, np.newaxis], []
    for u in inputs:
        truth.append(x)
        x = step.a @ x + step.b @ u
    seen = np.array(truth)[:, :1]
    run = observer.run(inputs, seen)
    assert np.allclose(run.x[-1], truth[-1], atol=1e-9) and np.allclose(observer.x, x, atol=1e-9)
    assert run.innovation[0, 0] == 1.0
    seen[50:] = np.nan
    again = kestirim.LuenbergerObserver(step.a, step.b, c, placed.gain, [0.0, 0.0])
    assert np.allclose(again.run(inputs, seen).x[-1], truth[-1], atol=1e-6)
    with pytest.raises(kestirim.KestirimError, match=r"gain: expected an array of shape \(2, 1\)"):
        kestirim.LuenbergerObserver(step.a, step.b, c, np.zeros((1, 2)), [0.0, 0.0])
    with pytest.raises(kestirim.KestirimError, match="expected 1 to 6 states, found 7"):
        kestirim.c2d(np.eye(7), np.ones((7, 1)), 0.1)
    with pytest.raises(kestirim.KestirimError):
        kestirim.place(np.eye(2), c, [0.1, 0.2])


def test_other_threads_run_meanwhile() -> None:
    filter = kestirim.KalmanFilter(**TRACK)
    zs = np.zeros((400_000, 2))
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    began = time.perf_counter()
    filter.filter(zs)
    ended = time.perf_counter()
    done.set()
    thread.join()
    # With the lock held, none would have come in between.
    assert sum(began < tick < ended for tick in ticks) > 5


def test_arrays_are_not_copied_in() -> None:
    from kestirim._check import floats

    array = np.zeros((5, 3))
    assert floats("a", array, 5, 3) is array
    assert floats("a", array[:, ::-1], 5, 3).flags.c_contiguous
    assert floats("a", np.zeros(5, np.float32), 5).dtype == np.float64
