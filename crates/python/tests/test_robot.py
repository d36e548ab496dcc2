"""Tags equal those of `host-sim replay robot` to the bit."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any, Optional

import numpy as np
import pytest
from conftest import STATES, Replay, said, table, vectors

import kestirim


class Ranges:
    """Anchors and ranges of a recording."""

    def __init__(self, folder: Path) -> None:
        with (folder / "anchors.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.names = [row["anchor"] for row in rows]
        self.anchors = np.array([[float(row[axis]) for axis in "xyz"] for row in rows])
        with (folder / "ranges.csv").open(newline="") as file:
            self.rows = [row for row in csv.DictReader(file) if row["anchor"] in self.names]
        self.anchor = [self.names.index(row["anchor"]) for row in self.rows]
        self.range = [float(row["range"] or "nan") for row in self.rows]

    @property
    def t(self) -> list[float]:
        return [float(row["t"]) for row in self.rows]


def equal(ours: kestirim.TagTrack, theirs: Any, track: list[dict[str, str]]) -> None:
    known = ~np.isnan(ours.position[:, 0])
    assert known.sum() == len(track) > 100
    for axis, name in enumerate("xyz"):
        assert said(ours.position[known, axis], 6) == [row[name] for row in track]
        assert said(ours.sigma[known, axis], 4) == [row[f"s{name}"] for row in track]
    assert [STATES[code] for code in ours.health[known]] == [row["health"] for row in track]
    assert ours.taken.sum() == theirs["updates"]
    assert ours.lost == theirs["lost_s"]
    assert list(ours.reasons) == [reason.replace("-", " ") for reason in theirs["health"]["reasons"]]
    assert set(ours.warnings) <= set(theirs["warnings"])


@pytest.mark.parametrize(
    ("name", "height", "options", "arguments"),
    [
        ("trek_4vba0", 1.2, {}, []),
        ("trek_m1l", 1.0, {"scalar": "fixed"}, ["--scalar", "fixed"]),
        ("lias_mid_tag0", 0.5, {"scalar": "f64", "room": (-10, -10, 10, 10)}, ["--scalar", "f64", "--room=-10,-10,10,10"]),
        ("inrol_env1", None, {"dim": 3}, ["--dim", "3"]),
        ("plaza1", None, {}, []),
        ("outdoor_square", None, {}, []),
    ],
)
def test_equals_replay(
    data: Path, replay: Replay, name: str, height: Optional[float], options: Any, arguments: list[str]
) -> None:
    folder = data / "robot" / name
    log = Ranges(folder)
    if height is not None:
        arguments = [*arguments, "--height", str(height)]
    files = ("--anchors", folder / "anchors.csv", "--log", folder / "ranges.csv")
    theirs, track = replay("robot", *files, *arguments)
    ours = kestirim.robot(log.anchors, log.t, log.anchor, log.range, height=height, **options)
    equal(ours, theirs, track)
    if "height" in theirs:
        assert ours.height == theirs["height"]["metres"]
        assert ours.height_sigma == theirs["height"]["sigma_m"]


def test_equals_replay_with_imu_and_calibration(data: Path, replay: Replay, tmp_path: Path) -> None:
    folder = data / "robot/esp32_wall2"
    log, imu = Ranges(folder), table(folder / "imu.csv")
    biases = [0.05, 0.1, -0.02]
    calibration = tmp_path / "calibration.csv"
    lines = [f"{name},{bias}" for name, bias in zip(log.names, biases)]
    calibration.write_text("\n".join(["anchor,bias", *lines, ""]))
    files = ("--anchors", folder / "anchors.csv", "--log", folder / "ranges.csv", "--imu", folder / "imu.csv")
    theirs, track = replay("robot", *files, "--calibration", calibration, "--height", "0.2")
    sensor = (imu["t"], vectors(imu, "lax", "lay", "laz"))
    ours = kestirim.robot(log.anchors, log.t, log.anchor, log.range, height=0.2, biases=biases, imu=sensor)
    equal(ours, theirs, track)


@pytest.mark.parametrize(("name", "height", "wheels"), [("plaza1", 0.0, True), ("esp32_wall2", 0.2, False)])
def test_smoothed_as_replay_smooths(data: Path, replay: Replay, name: str, height: float, wheels: bool) -> None:
    folder = data / "robot" / name
    log, options, files = Ranges(folder), {}, ["--anchors", folder / "anchors.csv", "--log", folder / "ranges.csv"]
    if wheels:
        files += ["--odom", folder / "odom.csv"]
        odom = table(folder / "odom.csv")
        speeds = (0.5 * (odom["v_left"] + odom["v_right"]), (odom["v_right"] - odom["v_left"]) / odom["track"])
        options = {"wheels": (odom["t"], *speeds)}
    theirs, track = replay("robot", *files, "--height", str(height), "--smooth")
    ours = kestirim.robot(log.anchors, log.t, log.anchor, log.range, height=height, smooth=True, **options)  # type: ignore[arg-type]
    if "smoothed" not in theirs:
        assert ours.smoothed is None and f"not smoothed: {ours.not_smoothed}" in theirs["warnings"]
        return
    assert ours.smoothed is not None and ours.not_smoothed is None
    assert len(ours.smoothed.t) == len(ours.t) == len(track)
    for axis, column in enumerate("xyz"):
        assert said(ours.smoothed.position[:, axis], 6) == [row[column] for row in track]
        assert said(ours.smoothed.sigma[:, axis], 4) == [row[f"s{column}"] for row in track]
    assert [STATES[code] for code in ours.smoothed.health] == [row["health"] for row in track]
    assert ours.smoothed.biases.tolist() == [[it["bias_m"], it["sigma_m"]] for it in theirs["smoothed"]["anchors"]]
    shared = ours.smoothed.common_bias + ours.smoothed.excess_in_10_m
    names = ("common_bias_m", "common_bias_sigma_m", "excess_in_10_m", "excess_in_10_m_sigma")
    assert shared == tuple(theirs["smoothed"][name] for name in names)
    assert list(ours.smoothed.to_dataframe().columns)[:3] == ["t", "position_x", "position_y"]


def test_equals_replay_with_wheels_and_heights(data: Path, replay: Replay, tmp_path: Path) -> None:
    folder = data / "robot/plaza1"
    log, odom = Ranges(folder), table(folder / "odom.csv")
    heights = ([log.t[0], log.t[-1]], [0.4, 0.6])
    written = tmp_path / "heights.csv"
    written.write_text("t,z\n" + "".join(f"{t!r},{z}\n" for t, z in zip(*heights)))
    files = ("--anchors", folder / "anchors.csv", "--log", folder / "ranges.csv", "--odom", folder / "odom.csv")
    theirs, track = replay("robot", *files, "--height", written)
    wheels = (odom["t"], 0.5 * (odom["v_left"] + odom["v_right"]), (odom["v_right"] - odom["v_left"]) / odom["track"])
    ours = kestirim.robot(log.anchors, log.t, log.anchor, log.range, heights=heights, wheels=wheels)
    equal(ours, theirs, track)


def test_what_only_the_whole_log_shows_is_told(data: Path) -> None:
    log = Ranges(data / "robot/trek_4vba0")
    sound = kestirim.robot(log.anchors, log.t, log.anchor, log.range, height=1.2)
    moved = log.anchors + np.eye(len(log.anchors))[:, :1] * [1.5, 0.0, 0.0]
    doubted = kestirim.robot(moved, log.t, log.anchor, log.range, height=1.2)
    assert any("anchor" in warning for warning in doubted.warnings), doubted.warnings
    assert len(doubted.warnings) > len(sound.warnings) and set(doubted.reasons) - set(sound.reasons)
    # A log that has anchor after anchor tells the same; each range keeps its place.
    order = np.argsort(log.anchor, kind="stable")
    t, anchor, distance = (np.asarray(column)[order] for column in (log.t, log.anchor, log.range))
    by_anchor = kestirim.robot(log.anchors, t, anchor, distance, height=1.2)
    assert "anchor after anchor" in by_anchor.warnings[0]
    assert len(by_anchor.t) == len(sound.t)
    assert by_anchor.taken.sum() > 0.98 * sound.taken.sum()
    assert (by_anchor.taken == sound.taken[order]).mean() > 0.98


def test_refusals() -> None:
    anchors = np.array([[0.0, 0.0, 2.0], [5.0, 0.0, 2.0], [0.0, 5.0, 2.0]])
    t, anchor, distance = [0.0, 0.1], [0, 1], [3.0, 3.0]
    for arguments, options, sentence in (
        ((anchors[:, :2], t, anchor, distance), {"height": 1.0}, r"anchors: expected an array of shape \(a, 3\), found \(3, 2\)"),
        ((anchors, t, [0, 3], distance), {"height": 1.0}, "sample 1: expected an anchor from 0 to 2, found 3"),
        ((anchors, t, [0, 0.5], distance), {"height": 1.0}, "anchor: expected whole numbers"),
        ((anchors[:2], t, anchor, distance), {}, "these anchors cannot be used: there are fewer than three anchors"),
        ((anchors, t, anchor, distance), {"height": 1.0, "dim": 4}, "dim: expected 2 or 3, found 4"),
        ((anchors, t, anchor, distance), {"height": None}, "the ranges do not tell the tag's height"),
        ((np.empty((0, 3)), t, anchor, distance), {"height": 1.0}, "anchors: expected at least one"),
        ((anchors, t, anchor, distance), {"heights": ([], [])}, "heights, times: expected at least one"),
        ((anchors, t, anchor, distance), {"heights": ([0.0, np.nan], [1.0, 1.0])}, "heights, times: expected finite numbers, found nan"),
        ((anchors, t, anchor, distance), {"height": 1.0, "imu": ([np.nan], np.zeros((1, 3)))}, "imu, times: expected finite numbers"),
        ((anchors, t, anchor, distance), {"height": 1.0, "biases": [0.1]}, r"biases: expected an array of shape \(3,\), found \(1,\)"),
    ):
        with pytest.raises(kestirim.KestirimError, match=sentence):
            kestirim.robot(*arguments, **options)  # type: ignore[arg-type]
