"""Users equal those of `host-sim replay drone` to the bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Replay, table, vectors

import kestirim


@pytest.mark.parametrize(
    ("name", "options", "arguments"),
    [
        ("afar_1204/stops.csv", {}, []),
        ("afar_1204/stops.csv", {"environment": "suburban"}, ["--environment", "suburban"]),
        ("collars/collar_000419_0.csv", {"environment": "urban"}, ["--environment", "urban"]),
        ("lora_20190619", {"every": False}, []),
        ("afar_1204/samples_2hz_attitude.csv", {"every": False}, []),
    ],
)
def test_equals_replay(data: Path, replay: Replay, name: str, options: Any, arguments: list[str]) -> None:
    log = data / "drone" / name
    log = next(path for path in sorted(log.glob("*.csv")) if "h," in path.read_text()[:40]) if log.is_dir() else log
    flight = table(log)
    area = log.with_name("area.csv")
    if area.exists():
        options = {**options, "area": vectors(table(area), "x", "y")}
        arguments = [*arguments, "--area", str(area)]
    if "heading_deg" in (flight.dtype.names or ()):
        options = {**options, "heading": flight["heading_deg"]}
    theirs, track = replay("drone", "--log", log, *arguments)
    place = vectors(flight, "x", "y")
    ours = kestirim.drone(flight["t"], place, flight["h"], rssi=flight["rssi_db"], **options)

    assert ours.position[-1].tolist() == [theirs["estimate"]["x"], theirs["estimate"]["y"]]
    assert ours.sigma[-1] == theirs["sd_m"]
    assert ours.level[-1] == theirs["level_db"]
    assert ours.measurements == theirs["measurements"]
    assert list(ours.reasons) == theirs["health"]["reasons"]
    assert set(ours.warnings) <= set(theirs["warnings"]) and bool(ours.warnings) == bool(ours.reasons)
    following = theirs.get("next_waypoint")
    assert ours.next_waypoint == (following and tuple(following[name] for name in ("x", "y", "height_m", "sd_m")))
    if options.get("every", True):
        assert len(ours.t) == len(track)
    rows = np.column_stack([ours.t, ours.position, ours.sigma])
    for row, expected in zip(rows, track[-len(rows) :]):
        assert [f"{value:.3f}" for value in row] == [expected[name] for name in ("t", "x", "y", "sd")]


def test_a_loss_of_known_power_is_found_and_refusals_are_sentences() -> None:
    t = np.arange(8.0)
    place = np.array([[0, 0], [400, 0], [400, 400], [0, 400], [200, 0], [0, 200], [400, 200], [200, 400]], float)
    user = np.array([150.0, 250.0])
    height = np.full(8, 60.0)
    distance = np.sqrt(((place - user) ** 2).sum(axis=1) + height**2)
    loss = 20 * np.log10(4 * np.pi / 0.15 * distance)
    found = kestirim.drone(t, place, height, path_loss=loss, every=False)
    assert np.hypot(*(found.position[-1] - user)) < 3 * found.sigma[-1]
    # On another frequency the same distances lose less: 13.3 dB at 433 MHz.
    lower = 20 * np.log10(4 * np.pi * 433e6 / 3e8 * distance)
    told = kestirim.drone(t, place, height, path_loss=lower, frequency=433e6, every=False)
    assert np.allclose(told.position[-1], found.position[-1], atol=0.1)
    # The last four alone tell less.
    few = kestirim.drone(t, place, height, path_loss=loss, window=3.5, every=False)
    assert few.sigma[-1] > found.sigma[-1]
    with pytest.raises(kestirim.KestirimError, match="window: expected more than 0 s, found 0"):
        kestirim.drone(t, place, height, path_loss=loss, window=0)
    with pytest.raises(kestirim.KestirimError, match="frequency: expected 3e7 to 3e10 Hz, found 2.4e0"):
        kestirim.drone(t, place, height, path_loss=loss, frequency=2.4)
    with pytest.raises(kestirim.KestirimError, match="at least three measurements .* found 2"):
        kestirim.drone(t[:2], place[:2], height[:2], path_loss=loss[:2])
    with pytest.raises(kestirim.KestirimError, match="path_loss or rssi"):
        kestirim.drone(t, place, height)
    with pytest.raises(kestirim.KestirimError, match="environment: expected 'open', .* found \"sea\""):
        kestirim.drone(t, place, height, rssi=-loss, environment="sea")  # type: ignore[arg-type]
    with pytest.raises(kestirim.KestirimError, match="area: expected the corners of an area"):
        kestirim.drone(t, place, height, rssi=-loss, area=np.zeros((2, 2)))
