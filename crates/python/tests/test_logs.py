"""Logs of inertial sensors, read as `host-sim` reads them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import Replay, table, vectors

import kestirim


def test_a_recorded_log_is_read_and_walked(data: Path, replay: Replay) -> None:
    path = sorted((data / "pedestrian/openshoe").glob("*.csv"))[0]
    log, written = kestirim.read_imu(path), table(path)
    assert np.array_equal(log.accel, vectors(written, "ax", "ay", "az"))
    assert np.array_equal(log.gyro, vectors(written, "gx", "gy", "gz"))
    assert log.mag is not None and log.mag.shape == log.accel.shape
    walk = kestirim.pedestrian(log.t, log.accel, log.gyro, "consumer", mag=log.mag)
    theirs, _ = replay("pedestrian", "--log", path, "--sensor", "consumer")
    assert walk.path_length == theirs["path_length_m"]
    assert list(log.understood) == theirs["import"]
    assert set(walk.warnings) <= set(theirs["warnings"])


def test_units_are_found_and_told(tmp_path: Path) -> None:
    turned = [(k * 10, 0.0, 0.02, 1.0, 20.0 * np.sin(k / 9), 0.5, -0.25) for k in range(600)]
    lines = ["t_ms;ax_g;ay_g;az_g;gx_dps;gy_dps;gz_dps"]
    lines += [";".join(f"{value:.4f}" for value in row) for row in turned]
    path = tmp_path / "walk.csv"
    path.write_text("\n".join(lines) + "\n")
    log = kestirim.read_imu(path)
    assert log.t[-1] == pytest.approx(5.99) and log.mag is None
    assert log.accel[0].tolist() == pytest.approx([0.0, 0.02 * 9.80665, 9.80665])
    assert log.gyro[:, 1] == pytest.approx(np.full(600, np.radians(0.5)), rel=1e-9)
    assert any("deg/s" in said or "°/s" in said for said in log.understood), log.understood
    assert np.allclose(kestirim.read_imu(path, units="acc=m/s2").accel * 9.80665, log.accel)


def test_what_cannot_be_read_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "words.txt"
    path.write_text("nothing\nto be\nread\n" * 20)
    with pytest.raises(kestirim.KestirimError, match=r"words\.txt: .*expected"):
        kestirim.read_imu(path)
    with pytest.raises(kestirim.KestirimError, match=r"absent: "):
        kestirim.read_imu(tmp_path / "absent")
    with pytest.raises(kestirim.KestirimError, match="units: "):
        kestirim.read_imu(path, units="acc=furlongs")
