"""Other packages' speed beside ours, in one run on one machine: `python benches/peers.py`.

Each does the same work on the same arrays; the best of several turns counts. Ours take an array a call, those that have
no such call are called in a loop, as their manuals show it.
"""

from __future__ import annotations

import importlib
import sys
import time
from collections.abc import Callable
from typing import Any, Optional

import numpy as np

import kestirim

SAMPLES = 20_000
TURNS = 5


def walk(samples: int) -> tuple[Any, Any, Any]:
    """A foot-mounted IMU, 200 Hz: steps and stances."""
    t = np.arange(samples) / 200.0
    swing = np.clip(np.sin(2 * np.pi * t / 1.2), 0.0, None)[:, np.newaxis]
    noise = np.random.default_rng(0).normal(size=(2, samples, 3))
    accel = [0.0, 0.0, 9.81] + swing * [4.0, 0.5, 3.0] + 0.05 * noise[0]
    return t, accel, swing * [0.2, 2.0, 0.1] + 0.005 * noise[1]


def constant_velocity() -> dict[str, Any]:
    """Position and velocity in the plane, of which the position is measured."""
    step = np.array([[1.0, 0.1], [0.0, 1.0]])
    return {
        "x": np.zeros(4),
        "P": np.eye(4),
        "F": np.kron(step, np.eye(2)),
        "H": np.eye(2, 4),
        "Q": 0.01 * np.eye(4),
        "R": np.eye(2),
    }


def best(work: Callable[[], object], samples: int) -> float:
    """Seconds a sample."""
    turns = []
    for _ in range(TURNS):
        began = time.perf_counter()
        work()
        turns.append(time.perf_counter() - began)
    return min(turns) / samples


def optional(name: str) -> Optional[Any]:
    """A package, if it is there."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


def kalman(samples: int = SAMPLES) -> dict[str, float]:
    """Kalman filters, 4 states and 2 measurements: predict and update."""
    of, zs = constant_velocity(), np.random.default_rng(1).normal(size=(samples, 2))
    took = {"kestirim": best(lambda: kestirim.KalmanFilter(**of).filter(zs), samples)}
    fewer = zs[:1000]
    if optional("filterpy"):
        peer = importlib.import_module("filterpy.kalman")

        def run() -> None:
            filter = peer.KalmanFilter(dim_x=4, dim_z=2)
            for name in ("P", "F", "H", "Q", "R"):
                setattr(filter, name, of[name])
            for z in fewer:
                filter.predict()
                filter.update(z)

        took["filterpy"] = best(run, len(fewer))
    if optional("stonesoup"):
        took["Stone Soup"] = best(stone_soup(of, fewer), len(fewer))
    return took


def stone_soup(of: dict[str, Any], zs: Any) -> Callable[[], None]:
    """Its predictor and updater of a linear Gaussian model."""
    import datetime

    linear = importlib.import_module("stonesoup.models.transition.linear")
    models = importlib.import_module("stonesoup.models.measurement.linear")
    updaters = importlib.import_module("stonesoup.updater.kalman")
    predictors = importlib.import_module("stonesoup.predictor.kalman")
    types = importlib.import_module("stonesoup.types.state")
    detection = importlib.import_module("stonesoup.types.detection").Detection
    hypothesis = importlib.import_module("stonesoup.types.hypothesis").SingleHypothesis
    axis = linear.ConstantVelocity(0.01)
    predictor = predictors.KalmanPredictor(linear.CombinedLinearGaussianTransitionModel([axis, axis]))
    measurement = models.LinearGaussian(4, mapping=[0, 2], noise_covar=of["R"])
    updater = updaters.KalmanUpdater(measurement)
    start = datetime.datetime(2026, 1, 1)

    def run() -> None:
        state = types.GaussianState(of["x"], of["P"], timestamp=start)
        for step, z in enumerate(zs, 1):
            now = start + datetime.timedelta(seconds=0.1 * step)
            found = detection(z, timestamp=now, measurement_model=measurement)
            state = updater.update(hypothesis(predictor.predict(state, timestamp=now), found))

    return run


def attitude(samples: int = SAMPLES) -> dict[str, float]:
    """Attitude from gyroscope and accelerometer; and ours with the whole path of the foot."""
    t, accel, gyro = walk(samples)
    took = {
        "kestirim": best(lambda: kestirim.attitude(t, gyro, accel), samples),
        "kestirim, whole tracker": best(lambda: kestirim.pedestrian(t, accel, gyro), samples),
    }
    if optional("imufusion"):
        peer = importlib.import_module("imufusion")
        degrees, forces = np.degrees(gyro), accel / 9.80665

        def run() -> None:
            ahrs = peer.Ahrs()
            ahrs.set_sample_period(1 / 200)
            for rate, force in zip(degrees, forces):
                ahrs.update_no_magnetometer(rate, force)

        took["imufusion"] = best(run, samples)
    if optional("ahrs"):
        filters = importlib.import_module("ahrs.filters")
        fewer = (gyro[:2000], accel[:2000])
        took["ahrs"] = best(lambda: filters.Mahony(gyr=fewer[0], acc=fewer[1], frequency=200.0), 2000)
    return took


def table(title: str, took: dict[str, float]) -> str:
    """As the book has it."""
    ours = took["kestirim"]
    rows = [f"| {name} | {1e6 * seconds:.2f} | {seconds / ours:.1f} |" for name, seconds in took.items()]
    return "\n".join([f"| {title} | µs a sample | times ours |", "|---|---|---|", *rows, ""])


def main() -> None:
    """Prints the tables."""
    print(f"Python {sys.version.split()[0]}, NumPy {np.__version__}, kestirim {kestirim.__version__}\n")
    print(table("Kalman filter, 4 states, 2 measurements", kalman()))
    print(table("IMU, 200 Hz", attitude()))


if __name__ == "__main__":
    main()
