"""Recordings from ../shared/data beside the repository, and what `host-sim replay` makes of them."""

from __future__ import annotations

import csv
import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parents[3]
DATA = REPOSITORY.parent / "shared" / "data"


def required(name: str) -> bool:
    """Whether CI insists."""
    return os.environ.get(name) == "1"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if "data" in getattr(item, "fixturenames", ()) and not DATA.is_dir():
            assert not required("KESTIRIM_REQUIRE_DATA"), f"{DATA} is absent"
            item.add_marker(pytest.mark.skip(reason=f"{DATA} is absent"))


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of the recordings."""
    return DATA


def _program() -> str | None:
    named = os.environ.get("KESTIRIM_HOST_SIM")
    built = [REPOSITORY / "target" / profile / "host-sim" for profile in ("release", "debug")]
    return named or next((str(path) for path in built if path.exists()), None)


class Replay:
    """Runs `host-sim replay`."""

    def __init__(self, program: str, folder: Path) -> None:
        self.program, self.folder = program, folder

    def __call__(self, system: str, *arguments: object, track: str = "track") -> tuple[Any, list[dict[str, str]]]:
        """The JSON, and the rows of the table."""
        out = self.folder / "track.csv"
        command = [self.program, "replay", system, *map(str, arguments), "--json", f"--{track}", str(out)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        with out.open(newline="") as file:
            return json.loads(done.stdout), list(csv.DictReader(file))


@pytest.fixture
def replay(tmp_path: Path) -> Replay:
    """`host-sim replay`, of the program that KESTIRIM_HOST_SIM names or that is built."""
    program = _program()
    if program is None:
        assert not required("KESTIRIM_REQUIRE_PYTHON"), "KESTIRIM_HOST_SIM names no program"
        pytest.skip("host-sim is not built")
    return Replay(program, tmp_path)


def table(path: Path) -> np.ndarray[Any, Any]:
    """A CSV with numbers only, by the names of its columns."""
    return np.genfromtxt(path, delimiter=",", names=True)


def vectors(columns: np.ndarray[Any, Any], *names: str) -> np.ndarray[Any, Any]:
    """Columns side by side."""
    return np.stack([columns[name] for name in names], axis=1)


def said(values: Any, decimals: int) -> list[str]:
    """As host-sim writes them in a table."""
    return ["" if np.isnan(value) else f"{value:.{decimals}f}" for value in values]


STATES = ("good", "degraded", "bad")
