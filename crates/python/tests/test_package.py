"""The package as its users and its stubs see it."""

from __future__ import annotations

import doctest
import importlib.util
import io
import json
import os
import re
import subprocess
import sys
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import REPOSITORY, required

import kestirim

HERE = Path(__file__).resolve().parents[1]
NOTEBOOKS = sorted((HERE / "notebooks").glob("*.ipynb"))


def blocks(path: Path) -> list[str]:
    """The Python of a page."""
    return re.findall(r"```python\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL)


def printed(code: str) -> str:
    out = io.StringIO()
    with redirect_stdout(out):
        exec(compile(code, "<page>", "exec"), {"__name__": "page"})
    return out.getvalue()


def test_version() -> None:
    manifest = (REPOSITORY / "Cargo.toml").read_text(encoding="utf-8")
    assert f'\nversion = "{kestirim.__version__}"\n' in manifest


def test_everything_public_has_a_docstring() -> None:
    for name in kestirim.__all__:
        assert name.startswith("__") or getattr(kestirim, name).__doc__, name
    assert issubclass(kestirim.KestirimError, ValueError)
    assert doctest.testmod(kestirim).failed == 0


def test_ten_lines_print_the_readmes_figures(data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(REPOSITORY)
    (code,) = blocks(REPOSITORY / "docs/src/python.md")
    path, points = printed(code).splitlines()
    assert path == "path length: mean 0.49 %, worst 1.31 %"
    assert "0.49 / 1.31 %" in (REPOSITORY / "README.md").read_text(encoding="utf-8")
    # The README's row is of the same recordings; the book's table of the robot has this number.
    assert points == "90 points: 8.7 cm"
    assert "| `default` | 8.7 |" in (REPOSITORY / "docs/src/robot.md").read_text(encoding="utf-8")


def test_the_readmes_example() -> None:
    (code,) = blocks(HERE / "README.md")
    assert printed(code).endswith("GOOD\n")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run(path: Path) -> None:
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    assert printed(code)
    assert all(not cell.get("outputs") for cell in cells), "outputs are not kept"


def test_there_is_a_notebook_a_system() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["drone", "gnss", "pedestrian", "robot", "uav"]


def mypy(*arguments: str) -> None:
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=HERE, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_types_are_checked(tmp_path: Path) -> None:
    use = tmp_path / "use.py"
    use.write_text(
        "import numpy as np\nimport kestirim\n"
        "walk = kestirim.pedestrian(np.zeros(2), np.zeros((2, 3)), np.zeros((2, 3)), sensor='consumer')\n"
        "length: float = walk.path_length + walk.strides.length.sum()\n"
        "filtered = kestirim.KalmanFilter([0], [[1]], [[1]], [[1]], [[1]], [1]).filter([1.0])\n"
        "x: float = filtered.x[-1, 0]\n"
    )
    # Its source: mypy checks nothing that is installed.
    package = HERE / "python/kestirim"
    mypy("mypy", "--strict", "--cache-dir", str(tmp_path), str(package), str(use))
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import kestirim\nkestirim.pedestrian([], [], [], sensor='toy')\n")
    with pytest.raises(AssertionError, match="Literal"):
        mypy("mypy", "--strict", "--cache-dir", str(tmp_path), str(wrong))


def test_stubs_tell_what_is_there() -> None:
    mypy("mypy.stubtest", "kestirim._kestirim", "--ignore-disjoint-bases")


def peers() -> Any:
    spec = importlib.util.spec_from_file_location("peers", HERE / "benches/peers.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.skipif(os.environ.get("KESTIRIM_WHEEL") != "1", reason="only a wheel is built for speed")
def test_speed_beside_other_packages() -> None:
    module = peers()
    for name in ("filterpy", "imufusion"):
        if module.optional(name) is None:
            assert not required("KESTIRIM_REQUIRE_PYTHON"), f"{name} is absent"
            pytest.skip(f"{name} is absent")
    kalman, imu = module.kalman(), module.attitude()
    assert kalman["filterpy"] >= 100 * kalman["kestirim"], kalman
    assert imu["imufusion"] >= imu["kestirim, whole tracker"], imu


def test_both_kalman_filters_of_the_comparison_agree() -> None:
    filterpy = pytest.importorskip("filterpy.kalman")
    of, zs = peers().constant_velocity(), np.random.default_rng(2).normal(size=(50, 2))
    peer = filterpy.KalmanFilter(dim_x=4, dim_z=2)
    for name in ("P", "F", "H", "Q", "R"):
        setattr(peer, name, of[name])
    ours = kestirim.KalmanFilter(**of).filter(zs)
    for z in zs:
        peer.predict()
        peer.update(z)
    assert np.allclose(ours.x[-1], peer.x.ravel()) and np.allclose(ours.P[-1], peer.P)
