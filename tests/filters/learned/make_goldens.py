#!/usr/bin/python3
"""Writes the files beside it: tiny networks with random weights, an image, and what torch makes of it.

    PYTHONPATH=build/release/python /usr/bin/python3 tests/filters/learned/make_goldens.py
"""

import json
import pathlib

import numpy
import torch

from ensonify.training.batches import to_input
from ensonify.training.export import write_model
from ensonify.training.networks import NetworkKind, make_network

HERE = pathlib.Path(__file__).parent


def random_network(kind):
    torch.manual_seed(7)
    network = make_network(kind)
    for part in network.modules():
        if isinstance(part, torch.nn.BatchNorm2d):  # no statistic at its start, where folding would change nothing
            torch.nn.init.normal_(part.weight, 1, 0.3)
            torch.nn.init.normal_(part.bias, 0, 0.3)
            torch.nn.init.normal_(part.running_mean, 0, 0.1)
            torch.nn.init.uniform_(part.running_var, 0.02, 0.2)
        elif isinstance(part, (torch.nn.Conv2d, torch.nn.ConvTranspose2d)):
            torch.nn.init.normal_(part.weight, 0, 0.25)
    return network.eval()


def main():
    image = numpy.random.default_rng(7).rayleigh(60, (70, 50)).clip(0, 255).astype(numpy.float32)
    numpy.save(HERE / "image.npy", image)
    for name in ("unet", "pix2pix"):
        kind = NetworkKind(name, 1)
        network = random_network(kind)
        multiple = 2**kind.depth
        padded = numpy.pad(image, [(0, -side % multiple) for side in image.shape], mode="reflect")
        with torch.no_grad():
            # Between no and yes, where errors would show.
            network.up[0].weight.div_(network(to_input(torch.from_numpy(padded), kind)[None, None]).std())
        with torch.no_grad():  # not folded: by the definition of batch normalisation
            output = network(to_input(torch.from_numpy(padded), kind)[None, None])[0, 0, :70, :50]
            output = torch.sigmoid(output) if name == "unet" else (torch.tanh(output) + 1) / 2
        write_model(HERE, network, kind, threshold=0.5, license="BSD-3-Clause", metrics={}, training={"data": "none"})
        for suffix in (".onnx", ".json"):
            (HERE / f"model{suffix}").replace(HERE / f"{name}{suffix}")
        numpy.save(HERE / f"{name}_probability.npy", output.numpy())
        print(name, json.loads((HERE / f"{name}.json").read_text())["parameters"], float(output.min()), float(output.max()))


if __name__ == "__main__":
    main()
