"""Walks equal those of `host-sim replay pedestrian` to the bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import STATES, Replay, said, table, vectors

import kestirim

GCP = (31, 36, 41, 46, 48, 57, 72, 81)


def walked(data: Path, walk: int, **options: Any) -> kestirim.Walk:
    log = table(data / f"pedestrian/gcp/exp{walk}_imu.csv")
    accel, gyro = vectors(log, "ax", "ay", "az"), vectors(log, "gx", "gy", "gz")
    return kestirim.pedestrian(log["t"], accel, gyro, **options)


@pytest.mark.parametrize(
    ("walk", "options", "arguments"),
    [
        (31, {}, ["--sensor", "industrial"]),
        (81, {"causal": True}, ["--sensor", "industrial", "--causal"]),
        (56, {"sensor": "consumer", "tracker": "lite"}, ["--sensor", "consumer", "--tracker", "lite"]),
        (48, {"scalar": "fixed"}, ["--sensor", "industrial", "--scalar", "fixed"]),
        (
            43,
            {"scalar": "f64", "contact_height": 0.04},
            ["--sensor", "industrial", "--scalar", "f64", "--contact-height", "0.04"],
        ),
    ],
)
def test_equals_replay(data: Path, replay: Replay, walk: int, options: Any, arguments: list[str]) -> None:
    log = data / f"pedestrian/gcp/exp{walk}_imu.csv"
    equal(walked(data, walk, **options), *replay("pedestrian", "--log", log, *arguments))


def test_equals_replay_with_a_magnetometer(data: Path, replay: Replay) -> None:
    path = sorted((data / "pedestrian/openshoe").glob("*.csv"))[0]
    log = table(path)
    accel, gyro = vectors(log, "ax", "ay", "az"), vectors(log, "gx", "gy", "gz")
    mag = vectors(log, "mx_G", "my_G", "mz_G")
    ours = kestirim.pedestrian(log["t"], accel, gyro, "consumer", mag=mag)
    theirs, track = replay("pedestrian", "--log", path, "--sensor", "consumer")
    equal(ours, theirs, track)
    assert ours.heading_rate is not None
    assert 60 * np.degrees(ours.heading_rate) == pytest.approx(theirs["heading_rate_deg_per_min"], rel=1e-14)


def equal(ours: kestirim.Walk, theirs: Any, track: list[dict[str, str]]) -> None:
    assert ours.path_length == theirs["path_length_m"]
    assert ours.closure == theirs["closure_m"]
    assert list(ours.reasons) == [reason.replace("-", " ") for reason in theirs["health"]["reasons"]]
    assert set(ours.warnings) <= set(theirs["warnings"]) and bool(ours.warnings) == bool(ours.reasons)
    strides = theirs["strides"]
    assert len(ours.strides) == len(strides)
    for column, names in ((ours.strides.position, "x y z"), (ours.strides.sigma, "sx sy sz")):
        expected = [[stride[name] for name in names.split()] for stride in strides]
        assert np.array_equal(column, np.reshape(expected, (-1, 3)))
    assert ours.strides.length.tolist() == [stride["length_m"] for stride in strides]
    assert ours.strides.t.tolist() == [stride["t"] for stride in strides]

    assert said(ours.t, 6) == [row["t"] for row in track]
    for axis, name in enumerate("xyz"):
        assert said(ours.position[:, axis], 6) == [row[name] for row in track]
        assert said(ours.sigma[:, axis], 4) == [row[f"s{name}"] for row in track]
    assert [STATES[code] for code in ours.health] == [row["health"] for row in track]


def test_results_are_frozen_arrays(data: Path) -> None:
    walk = walked(data, 48)
    count = len(walk.t)
    assert walk.position.shape == walk.velocity.shape == walk.sigma.shape == (count, 3)
    assert walk.orientation.shape == (count, 4)
    assert walk.stance.dtype == np.bool_ and 0 < walk.stance.sum() < count
    assert np.allclose(np.linalg.norm(walk.orientation, axis=1), 1.0, atol=1e-4)
    with pytest.raises(AttributeError):
        walk.t = walk.t  # type: ignore[misc]


def test_dataframes(data: Path) -> None:
    pytest.importorskip("pandas")
    walk = walked(data, 48)
    frame = walk.to_dataframe()
    assert list(frame.columns[:4]) == ["t", "position_x", "position_y", "position_z"]
    assert len(frame) == len(walk.t)
    assert len(walk.strides.to_dataframe()) == len(walk.strides)


def test_what_cannot_be_walked_is_refused() -> None:
    t, rest = np.arange(400) / 200, np.tile([0.0, 0.0, 9.81], (400, 1))
    still = np.zeros((400, 3))
    for arguments, sentence in (
        ((t, rest, still[:, :2]), r"gyro: expected an array of shape \(400, 3\), found \(400, 2\)"),
        ((t, rest[:9], still), r"accel: expected an array of shape \(400, 3\), found \(9, 3\)"),
        ((t[:1], rest[:1], still[:1]), "at least 2 samples, found 1"),
        ((t[::-1], rest, still), "sample 1: the sample is older than the one before it"),
        ((t, rest * np.nan, still), "sample 0: a component of the sample is not finite"),
        ((t - 1, rest, still), "sample 0: expected a time from 0 s on, found -1"),
        ((["a"], rest, still), "t: expected numbers"),
    ):
        with pytest.raises(kestirim.KestirimError, match=sentence):
            kestirim.pedestrian(*arguments)
    with pytest.raises(ValueError, match="sensor: expected 'industrial' or 'consumer', found \"toy\""):
        kestirim.pedestrian(t, rest, still, sensor="toy")  # type: ignore[arg-type]
