"""Converts arrays to the type and shape that the Rust module takes, contiguous; arrays that fit are not copied."""

from __future__ import annotations

from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from ._kestirim import KestirimError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]
Codes = npt.NDArray[np.uint8]
Complexes = npt.NDArray[np.complex128]
Shape = tuple[Union[int, str], ...]


def _said(shape: Shape) -> str:
    inside = ", ".join(str(length) for length in shape)
    return f"({inside},)" if len(shape) == 1 else f"({inside})"


def _refuse(name: str, shape: Shape, found: tuple[int, ...]) -> KestirimError:
    return KestirimError(f"{name}: expected an array of shape {_said(shape)}, found {_said(found)}")


def _fits(shape: Shape, found: tuple[int, ...]) -> bool:
    pairs = zip(shape, found)
    return len(shape) == len(found) and all(isinstance(a, str) or a == b for a, b in pairs)


def floats(name: str, value: npt.ArrayLike, *shape: Union[int, str]) -> Floats:
    """The value as a C-contiguous float64 array of this shape, in which a letter stands for any length."""
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise KestirimError(f"{name}: expected numbers: {error}") from error
    # `ascontiguousarray` turns a scalar into an array of shape (1,).
    found = np.shape(value) if array.shape == (1,) else array.shape
    if not _fits(shape, found):
        raise _refuse(name, shape, found)
    return array


def finite(name: str, value: npt.ArrayLike, *shape: Union[int, str]) -> Floats:
    """The value as `floats` converts it, all of whose numbers must be finite."""
    array = floats(name, value, *shape)
    wrong = np.flatnonzero(~np.isfinite(array))
    if wrong.size:
        raise KestirimError(f"{name}: expected finite numbers, found {array.flat[wrong[0]]}")
    return array


def ints(name: str, value: npt.ArrayLike, *shape: Union[int, str]) -> Ints:
    """The value as an int64 array of this shape; numbers that are not whole are refused."""
    given: npt.NDArray[Any] = np.asarray(value)
    if given.dtype.kind not in "iub":
        whole = floats(name, value, *shape)
        if not np.array_equal(whole, np.floor(whole)):
            raise KestirimError(f"{name}: expected whole numbers")
        given = whole
    if not _fits(shape, given.shape):
        raise _refuse(name, shape, given.shape)
    return np.ascontiguousarray(given, dtype=np.int64)


def maybe_floats(name: str, value: Optional[npt.ArrayLike], *shape: Union[int, str]) -> Optional[Floats]:
    """The value as `floats` converts it; None stays None."""
    return None if value is None else floats(name, value, *shape)
