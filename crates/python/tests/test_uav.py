"""Flights equal those of `host-sim replay uav` to the bit."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import STATES, Replay, said, table, vectors

import kestirim

OUTPUTS = ["q", "V", "theta"]
NAMES = ("alpha", "q", "V", "theta")


def check(ours: kestirim.FlightTrack, theirs: Any, track: list[dict[str, str]]) -> None:
    assert ours.state[-1].tolist() == theirs["estimate"]
    assert ours.rejected.tolist() == [output["rejected"] for output in theirs["innovations"]]
    assert list(ours.reasons) == theirs["health"]["reasons"]
    assert set(ours.warnings) <= set(theirs["warnings"]) and bool(ours.warnings) == bool(ours.reasons)
    assert said(ours.t, 6) == [row["t"] for row in track]
    for column, name in enumerate(NAMES):
        assert said(ours.state[:, column], 9) == [row[name] for row in track]
        assert said(ours.sigma[:, column], 9) == [row[f"s_{name}"] for row in track]
    assert [STATES[code] for code in ours.health] == [row["health"] for row in track]


@pytest.mark.parametrize(
    ("options", "arguments"),
    [
        ({}, []),
        ({"scalar": "f32", "ratio": 4.0}, ["--scalar", "f32", "--ratio", "4"]),
        ({"scalar": "fixed"}, ["--scalar", "fixed"]),
        (
            {"estimator": "luenberger", "poles": (-3 + 2j, -3 - 2j, -5, -6)},
            ["--estimator", "luenberger", "--poles=-3+2i,-3-2i,-5,-6"],
        ),
        (
            {"input_noise": (0.01, 0.05), "output_noise": [0.02, 0.5, 0.01]},
            ["--input-noise", "0.01,0.05", "--output-noise", "1,0.02,0.5,0.01"],
        ),
    ],
)
def test_equals_replay(data: Path, replay: Replay, tmp_path: Path, options: Any, arguments: list[str]) -> None:
    flight = table(data / "uav/flights/jsbsim_c172p_ident.csv")
    # What is measured, with gaps, and deviations from where the flight begins.
    columns = vectors(flight, "delta_e", "delta_t", *OUTPUTS)
    columns = columns - columns[0]
    columns[3::7, 3] = np.nan
    log = tmp_path / "log.csv"
    lines = [
        ",".join([repr(float(t)), *("" if np.isnan(value) else repr(float(value)) for value in row)])
        for t, row in zip(flight["t"], columns)
    ]
    log.write_text("\n".join([",".join(["t", "delta_e", "delta_t", *OUTPUTS]), *lines, ""]))
    theirs, track = replay("uav", "--log", log, "--model", "P3", *arguments)
    ours = kestirim.uav(flight["t"], columns[:, :2], columns[:, 2:], OUTPUTS, model="P3", **options)
    check(ours, theirs, track)


def test_equals_replay_with_a_model_of_ones_own_and_absolute_values(
    data: Path, replay: Replay, tmp_path: Path
) -> None:
    log = data / "uav/flights/attas_elv1.csv"
    flight = table(log)
    named = kestirim.UavModel.named("P3")
    trim = ([0.04, 0.0, 129.0, 0.03], [0.04, 1.0])
    model = tmp_path / "model.json"
    contents = {"A": named.a.tolist(), "B": named.b.tolist(), "trim": {"x": trim[0], "u": trim[1]}}
    model.write_text(json.dumps(contents))
    theirs, track = replay("uav", "--log", log, "--model", model, "--absolute")
    ours = kestirim.uav(
        flight["t"],
        vectors(flight, "delta_e", "delta_t"),
        vectors(flight, *NAMES),
        model=kestirim.UavModel(named.a, named.b, trim=trim),
        absolute=True,
    )
    check(ours, theirs, track)
    assert list(ours.to_dataframe().columns[:5]) == ["t", "state_alpha", "state_q", "state_V", "state_theta"]


def test_a_sensor_that_steps_is_told(data: Path) -> None:
    flight = table(data / "uav/flights/jsbsim_c172p_ident.csv")
    inputs, outputs = (vectors(flight, *names) for names in (("delta_e", "delta_t"), OUTPUTS))
    inputs, outputs = inputs - inputs[0], outputs - outputs[0]
    outputs[len(outputs) // 2 :, 1] += 20.0
    track = kestirim.uav(flight["t"], inputs, outputs, OUTPUTS, model="P3")
    assert any(warning.startswith("V ") and "step" in warning for warning in track.warnings), track.warnings
    assert (track.health == kestirim.Health.BAD).all() and track.reasons


def test_refusals() -> None:
    t, inputs, measured = np.arange(9) / 50, np.zeros((9, 2)), np.zeros((9, 2))
    for options, sentence in (
        ({"outputs": ["q", "h"]}, "outputs: expected names of alpha, q, V, theta, found 'h'"),
        ({"outputs": np.zeros((5, 4))}, r"measured: expected an array of shape \(9, 5\), found \(9, 2\)"),
        ({"model": "P9"}, "model: expected 'P1', 'P2', 'P3' or a UavModel, found \"P9\""),
        ({"absolute": True}, "expected a model with a trim"),
        ({"estimator": "sliding"}, "estimator: expected 'kalman' or 'luenberger'"),
        ({"poles": (-1, -2)}, "poles: expected 4, found 2"),
    ):
        with pytest.raises(kestirim.KestirimError, match=sentence):
            kestirim.uav(t, inputs, measured, **{"outputs": ["q", "V"], **options})  # type: ignore[arg-type]
    with pytest.raises(kestirim.KestirimError, match="sample 1: expected a later time"):
        kestirim.uav(t * 0, inputs, measured, ["q", "V"])
