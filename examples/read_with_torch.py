#!/usr/bin/python3
"""Reads a dataset with torch's loader, and counts what its masks hold: read_with_torch.py DATASET [SPLIT]

Needs python3-torch.
"""

import sys
import time

import torch

import ensonify.data


def main(folder, split):
    frames = ensonify.data.FrameDataset(folder, split, fields=("raw", "mask", "labels"))
    loader = torch.utils.data.DataLoader(frames, batch_size=8, shuffle=True, num_workers=2)
    print(f"{len(frames)} frames of {frames[0]['raw'].shape[0]} bins x {frames[0]['raw'].shape[1]} beams")
    echoes, pixels, labels = 0, 0, torch.zeros(6, dtype=torch.int64)
    start = time.monotonic()
    for batch in loader:
        echoes += int((batch["mask"] > 0).sum())
        pixels += batch["mask"].numel()
        labels += torch.bincount(batch["labels"].flatten().long(), minlength=6)
    print(f"{len(frames) / (time.monotonic() - start):.0f} frames a second")
    print(f"echoes: {100 * echoes / pixels:.2f} % of the pixels")
    for name, count in zip(("water", "direct", "multipath", "sidelobe", "shadow", "outside"), labels.tolist()):
        print(f"  {name:9s} {100 * count / pixels:6.2f} %")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "train")
