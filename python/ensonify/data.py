"""Datasets for training: frames of a folder, and frames without end, simulated as they are asked for.

Both work with torch.utils.data.DataLoader and its workers, and without torch. A sample is a dict of numpy arrays
[bins, beams] (`raw`, `mask`, ...) and of what the frame is: `pose` float64 [4, 4], `place`, `index`. `transform(sample)`
makes of it what your training wants.
"""

import importlib
import os
import typing

import numpy

from ._ensonify import ConfigError, Dataset, Recipe, set_threads

_torch_data: typing.Any = None
_Iterable: typing.Any = object
try:
    _torch_data = importlib.import_module("torch.utils.data")
    _Iterable = _torch_data.IterableDataset
except ImportError:
    pass

Sample = typing.Dict[str, typing.Any]
Transform = typing.Callable[[Sample], typing.Any]

IMAGES = ("raw", "clean", "mask", "labels")
LAYERS = IMAGES + ("raw_level", "clean_level", "direct", "multipath", "sidelobe", "elevation", "elevation_min",
                   "elevation_max", "incidence", "instance")


def _check(fields: typing.Union[str, typing.Sequence[str]], known: typing.Sequence[str]) -> typing.Tuple[str, ...]:
    fields = (fields,) if isinstance(fields, str) else fields
    for field in fields:
        if field not in known:
            raise ConfigError(f"field '{field}' is none of {', '.join(known)}")
    return tuple(fields)


class FrameDataset:
    """The frames of one split of a dataset on disk, by number: len(d), d[i].

    `fields`: of raw, clean, mask, labels; only these are decoded. Random access to a WebDataset reads a shard a frame:
    make folders for training by number. Raises DataError, ConfigError, IndexError.
    """

    def __init__(self, folder: "str | os.PathLike[str]", split: str = "train", *,
                 fields: typing.Sequence[str] = ("raw", "mask"), transform: typing.Optional[Transform] = None) -> None:
        self.folder = os.fspath(folder)
        self.split = split
        self.fields = _check(fields, IMAGES)
        self.transform = transform
        self._dataset = Dataset(self.folder)
        if split not in self._dataset.splits:
            raise ConfigError(f"split '{split}' is none of the dataset's: {', '.join(self._dataset.splits)}")
        self._frames: int = self._dataset.splits[split]

    def __len__(self) -> int:
        return self._frames

    def __getitem__(self, index: int) -> typing.Any:
        if not -self._frames <= index < self._frames:
            raise IndexError(f"split {self.split} has frames 0 to {self._frames - 1}")
        index %= self._frames
        sample: Sample = self._dataset.images(self.split, index, list(self.fields))
        info = self._dataset.info(self.split, index)
        sample["pose"] = numpy.array(info["T_world_sonar"], dtype=numpy.float64).reshape(4, 4)
        sample["place"] = info["place"]
        sample["index"] = index
        return self.transform(sample) if self.transform else sample

    def __getstate__(self) -> Sample:
        return {**self.__dict__, "_dataset": None}

    def __setstate__(self, state: Sample) -> None:
        self.__dict__.update(state)
        self._dataset = Dataset(self.folder)


class EndlessFrames(_Iterable):  # type: ignore[misc]
    """Frames that no set holds, simulated as they are asked for: random places, poses and noise of a recipe's split.

    Frame k is a pure function of (seed, epoch, rank, k). With W workers, worker w makes the frames k = w, w + W, ...:
    none twice, the same frames for any W, in the same order for the same W. `frames` ends an epoch after so many
    (None: never); call set_epoch() before the next one, or it brings the same frames. `rank` tells processes of one
    training apart. `recipe`: as Recipe() takes it; `fields` as the arrays of Ping, None where the noise does not model
    one. In a DataLoader's worker, threads are limited to the worker's share of the cores; each worker builds its own
    places (about 50 MB and half a second each).
    """

    def __init__(self, recipe: typing.Any, split: str = "train", *, seed: int = 0, rank: int = 0,
                 frames: typing.Optional[int] = None, fields: typing.Sequence[str] = ("raw", "mask"),
                 transform: typing.Optional[Transform] = None) -> None:
        checked = Recipe(recipe)
        if split not in checked.splits:
            raise ConfigError(f"split '{split}' is none of the recipe's: {', '.join(checked.splits)}")
        if seed < 0 or rank < 0 or (frames is not None and frames < 1):
            raise ValueError("seed and rank must not be negative, frames at least 1")
        self.recipe = recipe
        self.split = split
        self.seed = seed
        self.rank = rank
        self.frames = frames
        self.fields = _check(fields, LAYERS)
        self.transform = transform
        self.epoch = 0
        self._made: typing.Optional[Recipe] = checked

    def set_epoch(self, epoch: int) -> None:
        """Names the next frames. Workers that persist do not hear of it."""
        if epoch < 0:
            raise ValueError("epoch must not be negative")
        self.epoch = epoch

    def frame(self, k: int) -> typing.Any:
        """Sample k of this epoch."""
        if self._made is None:
            self._made = Recipe(self.recipe)
        made = self._made.draw_frame(self.split, self.seed, [self.epoch, self.rank, k])
        sample: Sample = {field: getattr(made, field) for field in self.fields}
        sample.update(pose=made.pose, place=made.place, index=k)
        return self.transform(sample) if self.transform else sample

    def __iter__(self) -> typing.Iterator[typing.Any]:
        first, step = 0, 1
        worker = _torch_data.get_worker_info() if _torch_data else None
        if worker is not None:
            first, step = worker.id, worker.num_workers
            set_threads(max(1, (os.cpu_count() or 1) // worker.num_workers))
        k = first
        while self.frames is None or k < self.frames:
            yield self.frame(k)
            k += step

    def __getstate__(self) -> Sample:
        return {**self.__dict__, "_made": None}
