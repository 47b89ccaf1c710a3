#!/usr/bin/python3
"""The skeleton of a training without a dataset on disk: train_on_the_fly.py [STEPS]

A small convolutional network learns the mask from raw images that are simulated while it trains. Needs python3-torch.
"""

import sys

import numpy
import torch

import ensonify.data

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 200


def crop(sample):
    """128 x 128 about a place that the frame's number names, as torch likes it: one channel, 0..1."""
    rng = numpy.random.default_rng(sample["index"])
    top, left = (rng.integers(size - 128 + 1) for size in sample["raw"].shape)
    window = numpy.s_[None, top:top + 128, left:left + 128]
    return {name: torch.from_numpy(numpy.ascontiguousarray(sample[name][window])).float() / 255
            for name in ("raw", "mask")}


if __name__ == "__main__":  # workers may import this file
    frames = ensonify.data.EndlessFrames("quick", seed=1, transform=crop)
    loader = torch.utils.data.DataLoader(frames, batch_size=8, num_workers=2)

    torch.manual_seed(1)
    model = torch.nn.Sequential(torch.nn.Conv2d(1, 8, 7, padding=3), torch.nn.ReLU(),
                                torch.nn.Conv2d(8, 8, 7, padding=3), torch.nn.ReLU(), torch.nn.Conv2d(8, 1, 1))
    optimiser = torch.optim.Adam(model.parameters(), lr=3e-3)
    loss_of = torch.nn.BCEWithLogitsLoss()
    losses = []
    for step, batch in zip(range(steps), loader):
        loss = loss_of(model(batch["raw"]), batch["mask"])
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
        if step % 20 == 0 or step == steps - 1:
            print(f"step {step:4d}  loss {loss.item():.4f}")
    print(f"mean loss of the first 5 steps {numpy.mean(losses[:5]):.4f}, of the last 5 {numpy.mean(losses[-5:]):.4f}")
