"""Receivers equal those of `host-sim replay gnss` to the bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from conftest import STATES, Replay, said

import kestirim


def check(ours: kestirim.ReceiverTrack, theirs: Any, track: list[dict[str, str]]) -> None:
    assert ours.position[-1].tolist() == theirs["position_ecef_m"]
    assert ours.sigma[-1].tolist() == theirs["sd_enu_m"]
    assert ours.epochs == theirs["epochs"]
    assert said(ours.t, 6) == [row["t"] for row in track]
    for axis, name in enumerate("xyz"):
        assert said(ours.position[:, axis], 6) == [row[name] for row in track]
    for axis, name in enumerate("enu"):
        assert said(ours.sigma[:, axis], 6) == [row[f"sd{name}"] for row in track]
    assert [STATES[code] for code in ours.health] == [row["health"] for row in track]


def test_equals_replay_of_gps(data: Path, replay: Replay) -> None:
    folder = data / "gnss/esbc2020177"
    obs, antex, clk = folder / "esbc_gps.rnx.gz", folder / "esbc.atx.gz", folder / "grg177_gps.clk.gz"
    sp3 = [folder / "grg176_gps.sp3.gz", folder / "grg177_gps.sp3.gz"]
    files = ["--obs", obs, "--sp3", sp3[0], "--sp3", sp3[1], "--clk", clk, "--antex", antex]
    theirs, track = replay("gnss", *files, "--until", 7200)
    ours = kestirim.gnss(obs, sp3, antex, clk=clk, until=7200.0)
    check(ours, theirs, track)
    assert ours.converged[-1]

    theirs, track = replay("gnss", *files, "--until", 3600, "--mode", "kinematic", "--filter", "ikf", "--mask", 12, "--gradient", 0.001)
    options: Any = {"process_noise": 100.0, "filter": "ikf", "mask": 12 * 3.141592653589793 / 180, "gradient": 0.001}
    check(kestirim.gnss(obs, sp3, antex, clk=[clk], until=3600.0, **options), theirs, track)

    _, track = replay("gnss", *files, "--until", 3600, "--smooth")
    smoothed = kestirim.gnss(obs, sp3, antex, clk=clk, until=3600.0, smooth=True)
    assert said(smoothed.position[:, 0], 6) == [row["x"] for row in track]
    assert said(smoothed.sigma[:, 2], 6) == [row["sdu"] for row in track]
    assert smoothed.converged[0] and [STATES[code] for code in smoothed.health] == [row["health"] for row in track]


def test_single_positions_equal_those_of_replay(data: Path, replay: Replay) -> None:
    folder = data / "gnss/esbc2020177"
    obs, antex, sp3 = folder / "esbc_gps.rnx.gz", folder / "esbc.atx.gz", folder / "grg177_gps.sp3.gz"
    theirs, track = replay("gnss", "--obs", obs, "--sp3", sp3, "--antex", antex, "--until", 3600, "--method", "single")
    ours = kestirim.gnss(obs, sp3, antex, until=3600.0, method="single")
    check(ours, theirs, track)
    assert not ours.converged.any() and len(ours.t) > 100
    # Without precise orbits, what satellites broadcast is looked for.
    with pytest.raises(kestirim.KestirimError, match="broadcast.rnx"):
        kestirim.gnss(obs, nav=folder / "broadcast.rnx")


def test_equals_replay_with_galileo(data: Path, replay: Replay) -> None:
    folder = data / "gnss/esbc2020177_multi"
    obs = folder / "ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz"
    sp3 = sorted(folder.glob("*ORB.SP3.gz"))
    clk = next(folder.glob("*CLK.CLK.gz"))
    antex = [data / "gnss/esbc2020177/esbc.atx.gz", folder / "galileo_igs20.atx.gz"]
    named = [("--sp3", path) for path in sp3] + [("--antex", path) for path in antex]
    files = ["--obs", obs, "--clk", clk, *(word for pair in named for word in pair)]
    theirs, track = replay("gnss", *files, "--until", 1800)
    check(kestirim.gnss(obs, sp3, antex, clk=clk, until=1800.0), theirs, track)


def test_refusals(tmp_path: Path) -> None:
    with pytest.raises(kestirim.KestirimError, match="nowhere.rnx"):
        kestirim.gnss(tmp_path / "nowhere.rnx", "a.sp3", "a.atx")
    wrong = tmp_path / "wrong.rnx"
    wrong.write_text("what\n")
    with pytest.raises(kestirim.KestirimError, match="wrong.rnx"):
        kestirim.gnss(wrong, wrong, wrong)
    with pytest.raises(kestirim.KestirimError, match="antex: expected"):
        kestirim.gnss(wrong, wrong)
    with pytest.raises(kestirim.KestirimError, match="smooth: expected"):
        kestirim.gnss(wrong, wrong, wrong, method="single", smooth=True)
    with pytest.raises(kestirim.KestirimError, match="filter: expected 'default', .* found \"best\""):
        kestirim.gnss(wrong, wrong, wrong, filter="best")  # type: ignore[arg-type]
