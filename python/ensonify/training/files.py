"""Files that appear whole or not at all, and checkpoints."""

import contextlib
import os
import pathlib
import typing

import torch

from ensonify import DataError


@contextlib.contextmanager
def whole_file(path: pathlib.Path) -> typing.Iterator[pathlib.Path]:
    """A path beside `path` to write to; it becomes `path` when the block ends well."""
    beside = path.with_name(f".{path.name}.tmp{os.getpid()}")
    try:
        yield beside
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def save_checkpoint(path: pathlib.Path, state: typing.Dict[str, typing.Any]) -> None:
    with whole_file(path) as beside:
        torch.save(_mapped(state, _hidden), beside)


def load_checkpoint(path: pathlib.Path) -> typing.Dict[str, typing.Any]:
    """What save_checkpoint() wrote, on the CPU. Only tensors and plain values are accepted: a checkpoint runs no code.
    Raises DataError."""
    try:
        state = _mapped(torch.load(path, map_location="cpu", weights_only=True), _shown)
    except OSError as fault:
        raise DataError(f"{path}: {fault.strerror}; name a checkpoint.pt that a training wrote") from None
    except Exception as fault:  # torch.load raises whatever its parts do
        raise DataError(f"{path}: no checkpoint of ensonify.training, or broken ({type(fault).__name__})") from None
    if not isinstance(state, dict) or not {"options", "trainer", "step", "best"} <= state.keys():
        raise DataError(f"{path}: no checkpoint of ensonify.training; name a checkpoint.pt that a training wrote")
    return state


# torch 1.13 loads no floats where it must load safely: they travel as numbers of 64 bits without a shape.
def _hidden(value: typing.Any) -> typing.Any:
    return torch.tensor(value, dtype=torch.float64) if isinstance(value, float) else value


def _shown(value: typing.Any) -> typing.Any:
    is_float = isinstance(value, torch.Tensor) and value.dtype == torch.float64 and value.dim() == 0
    return float(value) if is_float else value


def _mapped(value: typing.Any, change: typing.Callable[[typing.Any], typing.Any]) -> typing.Any:
    if isinstance(value, dict):
        return {key: _mapped(item, change) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(_mapped(item, change) for item in value)
    return change(value)
