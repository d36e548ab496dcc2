"""What slept goes on to the bit; what is torn or another's is refused."""

from __future__ import annotations

import threading
from typing import Any, Callable

import numpy as np
import pytest

import kestirim

RNG = np.random.default_rng(11)
MODEL: dict[str, Any] = {
    "x": [0.0, 1.0],
    "P": np.eye(2),
    "F": [[1.0, 0.1], [0.0, 1.0]],
    "H": [[1.0, 0.0]],
    "Q": 0.01 * np.eye(2),
    "R": [[0.25]],
}
LEARNING: dict[str, Any] = {"forgetting": 0.95, "r_limits": (0.01, 4.0), "q_limits": (1e-6, 1.0)}
FILTERS: dict[str, Callable[[], Any]] = {
    "plain": lambda: kestirim.KalmanFilter(**MODEL),
    "adaptive": lambda: kestirim.AdaptiveKalmanFilter(**MODEL, **LEARNING),
    "robust": lambda: kestirim.RobustKalmanFilter(**MODEL),
}


@pytest.mark.parametrize("kind", FILTERS)
def test_a_filter_goes_on_to_the_bit(kind: str) -> None:
    zs = RNG.normal(size=(60, 1))
    for cut in RNG.integers(0, 60, size=20):
        awake, asleep = FILTERS[kind](), FILTERS[kind]()
        awake.filter(zs[:cut])
        asleep.restore(awake.snapshot())
        expected, found = awake.filter(zs[cut:]), asleep.filter(zs[cut:])
        for part in ("x", "P", "innovation", "nis"):
            assert np.array_equal(getattr(found, part), getattr(expected, part))


def test_particles_draw_the_same_numbers() -> None:
    def make() -> kestirim.ParticleFilter:
        return kestirim.ParticleFilter(300, [-5.0, -5.0], [5.0, 5.0], seed=3)

    def go_on(cloud: kestirim.ParticleFilter) -> None:
        cloud.update(-np.sum((cloud.states - 1.0) ** 2, axis=1))
        cloud.resample("residual")
        cloud.regularise(0.5)

    awake, asleep = make(), make()
    go_on(awake)
    asleep.restore(awake.snapshot())
    for cloud in (awake, asleep):
        go_on(cloud)
    assert np.array_equal(awake.states, asleep.states)
    fewer = kestirim.ParticleFilter(200, [-5.0, -5.0], [5.0, 5.0])
    with pytest.raises(kestirim.KestirimError, match="a cloud of 200 particles, found one of a cloud of 300"):
        fewer.restore(awake.snapshot())


def test_a_thread_with_little_stack_is_enough() -> None:
    clouds: list[kestirim.ParticleFilter] = []

    def make() -> None:
        cloud = kestirim.ParticleFilter(8192, 6 * [-5.0], 6 * [5.0])
        cloud.restore(cloud.snapshot())
        clouds.append(cloud)

    usual = threading.stack_size(256 << 10)
    thread = threading.Thread(target=make)
    try:
        thread.start()
    finally:
        threading.stack_size(usual)
    thread.join()
    assert clouds[0].states.shape == (8192, 6)


def test_an_observer_goes_on_to_the_bit() -> None:
    def make() -> kestirim.LuenbergerObserver:
        return kestirim.LuenbergerObserver(
            MODEL["F"], [[0.0], [0.1]], MODEL["H"], [[0.5], [0.3]], [0.0, 0.0]
        )

    us, ys = RNG.normal(size=(2, 40, 1))
    awake, asleep = make(), make()
    awake.run(us[:13], ys[:13])
    asleep.restore(awake.snapshot())
    expected, found = awake.run(us[13:], ys[13:]), asleep.run(us[13:], ys[13:])
    assert np.array_equal(found.x, expected.x)
    two = kestirim.LuenbergerObserver(MODEL["F"], [[0.0], [0.1]], np.eye(2), 0.3 * np.eye(2), [0.0, 0.0])
    with pytest.raises(kestirim.KestirimError, match="outputs: 1, found one of .* outputs: 2"):
        awake.restore(two.snapshot())


def test_what_is_torn_or_anothers_is_refused_and_changes_nothing() -> None:
    filters = {kind: make() for kind, make in FILTERS.items()}
    snapshot = filters["plain"].snapshot()
    torn = bytearray(snapshot)
    torn[len(torn) // 2] ^= 1
    for wrong in (b"", snapshot[:-1], bytes(torn), b"no snapshot at all, but long enough to be one" * 3):
        with pytest.raises(kestirim.KestirimError):
            filters["plain"].restore(wrong)
    with pytest.raises(kestirim.KestirimError, match="kalman"):
        filters["adaptive"].restore(snapshot)
    with pytest.raises(kestirim.KestirimError, match="a robust filter, measurements: 1, found one of a plain"):
        filters["robust"].restore(snapshot)
    two = kestirim.AdaptiveKalmanFilter(**{**MODEL, "H": np.eye(2), "R": [0.25, 0.25]}, **LEARNING)
    with pytest.raises(kestirim.KestirimError, match="measurements: 2, found one of .* measurements: 1"):
        two.restore(filters["adaptive"].snapshot())
    larger = kestirim.KalmanFilter(np.zeros(3), np.eye(3), np.eye(3), [[1.0, 0.0, 0.0]], np.eye(3), [1.0])
    with pytest.raises(kestirim.KestirimError):
        larger.restore(snapshot)
    assert filters["plain"].snapshot() == snapshot
