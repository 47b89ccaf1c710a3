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
        torch.save(state, beside)


def load_checkpoint(path: pathlib.Path) -> typing.Dict[str, typing.Any]:
    """What save_checkpoint() wrote, on the CPU. Only tensors and plain values are accepted: a checkpoint runs no code.
    Raises DataError."""
    try:
        state = torch.load(path, map_location="cpu", weights_only=True)
    except OSError as fault:
        raise DataError(f"{path}: {fault.strerror}; name a checkpoint.pt that a training wrote") from None
    except Exception as fault:  # torch.load raises whatever its parts do
        raise DataError(f"{path}: no checkpoint of ensonify.training, or broken ({type(fault).__name__})") from None
    if not isinstance(state, dict) or not {"options", "trainer", "step", "best"} <= state.keys():
        raise DataError(f"{path}: no checkpoint of ensonify.training; name a checkpoint.pt that a training wrote")
    return state
