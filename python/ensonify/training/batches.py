"""Batches of training crops, the same for any number of workers and after any interruption."""

import collections
import concurrent.futures
import itertools
import typing

import numpy
import torch

from .networks import NetworkKind
from .sources import Array, Source, frame_number

CROP = 256  # pixels; the published size
ENLARGED = 286  # what pix2pix enlarges a crop to before it cuts it again


class Batch(typing.NamedTuple):
    """image: float32 [n, 1, 256, 256] on the network's input range; mask: float32, 0 or 1; clean: 0..1, or None."""

    image: torch.Tensor
    mask: torch.Tensor
    clean: typing.Optional[torch.Tensor]

    def to(self, device: torch.device) -> "Batch":
        return Batch(self.image.to(device), self.mask.to(device), None if self.clean is None else self.clean.to(device))


def to_input(grey: torch.Tensor, kind: NetworkKind) -> torch.Tensor:
    """Grey levels 0..255 [..., bins, beams] on the network's input range."""
    low, high = kind.input_range
    return grey * ((high - low) / 255) + low


def batches(source: Source, kind: NetworkKind, *, size: int, per_frame: int, seed: int, first_step: int,
            workers: int) -> typing.Iterator[Batch]:
    """Batches from `first_step` on. Crop c is of frame c // per_frame; its place and flip follow from (seed, c)."""
    first_crop = first_step * size
    frames = _frames(source, seed, first_crop // per_frame, workers)
    number, pair = next(frames)
    crops: typing.List[typing.List[Array]] = []
    for c in itertools.count(first_crop):
        while number < c // per_frame:
            number, pair = next(frames)
        images = [pair.raw, pair.mask.astype(numpy.float32), *([pair.clean] if kind.clean else [])]
        crops.append(_crop(images, kind, numpy.random.default_rng([seed, 2, c])))
        if len(crops) == size:
            raws, masks, *cleans = (torch.from_numpy(numpy.stack(images)[:, None]) for images in zip(*crops))
            yield Batch(to_input(raws, kind), masks, cleans[0] / 255 if cleans else None)
            crops = []


def _frames(source: Source, seed: int, first: int, workers: int) -> typing.Iterator[typing.Any]:
    """(n, frame n) from `first` on, made ahead by `workers` threads."""
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        ahead: typing.Deque[typing.Any] = collections.deque()
        try:
            for n in itertools.count(first):
                ahead.append((n, pool.submit(source.frame, frame_number(source.size, seed, n))))
                if len(ahead) > 2 * workers:
                    number, future = ahead.popleft()
                    yield number, future.result()
        finally:
            for _, future in ahead:
                future.cancel()


def _crop(images: typing.List[Array], kind: NetworkKind, random: typing.Any) -> typing.List[Array]:
    """One square of raw, mask and what else there is, at a random place, left and right swapped in half of the cases: port
    and starboard are alike, near and far are not. Images smaller than it are mirrored at their far sides."""
    missing = [(0, max(0, CROP - side)) for side in images[0].shape]
    if any(after for _, after in missing):
        images = [numpy.pad(image, missing, mode="symmetric") for image in images]
    row, column = (int(random.integers(side - CROP + 1)) for side in images[0].shape)
    images = [image[row:row + CROP, column:column + CROP] for image in images]
    if kind.name == "pix2pix":
        top, left = (int(random.integers(ENLARGED - CROP + 1)) for _ in range(2))
        grey, truth = (_enlarged(image)[top:top + CROP, left:left + CROP] for image in images)
        images = [grey.clip(0, 255), (truth >= 0.5).astype(numpy.float32)]  # bicubic: beyond the ends, between 0 and 1
    if random.random() < 0.5:
        images = [image[:, ::-1] for image in images]
    return [numpy.ascontiguousarray(image) for image in images]


def _enlarged(image: Array) -> Array:
    tensor = torch.from_numpy(numpy.ascontiguousarray(image))[None, None]
    return torch.nn.functional.interpolate(tensor, (ENLARGED, ENLARGED), mode="bicubic", align_corners=False)[0, 0].numpy()
