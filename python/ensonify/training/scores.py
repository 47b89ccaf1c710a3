"""Mask scores on validation frames at every threshold at once."""

import collections
import math
import typing

import numpy
import torch

from .batches import to_input
from .networks import NetworkKind, folded, UNet
from .sources import Array, Pair

LEVELS = 256  # thresholds k / 256


class Scores(typing.NamedTuple):
    """Pooled over all pixels at `threshold`, the one of the best IoU. clean_psnr_db: of the clean head, mean over frames;
    none without such a head."""

    threshold: float
    iou: float
    f1: float
    precision: float
    recall: float
    iou_by_scene: typing.Dict[str, float]
    clean_psnr_db: typing.Optional[float]


def outputs(network: torch.nn.Module, kind: NetworkKind, raw: Array, device: torch.device) -> Array:
    """The folded network's heads [heads, bins, beams] for grey levels of any size, mirrored at the far sides up to the
    network's multiple."""
    multiple = 2**kind.depth
    padded = numpy.pad(raw, [(0, -side % multiple) for side in raw.shape], mode="reflect" if min(raw.shape) > 1 else "edge")
    with torch.no_grad():
        output = network(to_input(torch.from_numpy(padded), kind)[None, None].to(device))[0]
    return output[:, :raw.shape[0], :raw.shape[1]].cpu().numpy()


def validate(network: UNet, kind: NetworkKind, frames: typing.Sequence[typing.Callable[[], Pair]],
             device: torch.device) -> Scores:
    used = folded(network, kind).to(device)
    # Pixels by scene, truth and level of probability.
    counts: typing.Dict[str, Array] = collections.defaultdict(lambda: numpy.zeros((2, LEVELS), numpy.int64))
    psnr_db = []
    for frame in frames:
        pair = frame()
        heads = outputs(used, kind, pair.raw, device)
        if kind.clean:
            mse = float(numpy.mean((heads[1] - pair.clean / 255) ** 2, dtype=numpy.float64))
            psnr_db.append(-10 * math.log10(max(mse, 1e-10)))
        level = numpy.minimum(heads[0] * LEVELS, LEVELS - 1).astype(numpy.int64)
        for truth in (0, 1):
            counts[pair.scene][truth] += numpy.bincount(level[pair.mask == truth], minlength=LEVELS)
    # Threshold 0 marks everything: no choice.
    rates = [_rates(sum(counts.values()), k) for k in range(1, LEVELS)]
    best = int(numpy.argmax([r[0] for r in rates])) + 1
    iou, f1, precision, recall = rates[best - 1]
    return Scores(best / LEVELS, iou, f1, precision, recall,
                  {scene: _rates(count, best)[0] for scene, count in sorted(counts.items())},
                  sum(psnr_db) / len(psnr_db) if psnr_db else None)


def _rates(count: Array, k: int) -> typing.Tuple[float, float, float, float]:
    """IoU, F1, precision, recall where level k and above are called echoes; 0 where there is nothing to divide by."""
    hits, false = int(count[1, k:].sum()), int(count[0, k:].sum())
    missed = int(count[1, :k].sum())

    def share(part: int, whole: int) -> float:
        return part / whole if whole else 0.0
    return (share(hits, hits + false + missed), share(2 * hits, 2 * hits + false + missed), share(hits, hits + false),
            share(hits, hits + missed))
