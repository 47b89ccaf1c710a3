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


class TwoHeads(torch.nn.Module):
    """Down and up twice, to two channels by a transposed convolution."""

    def __init__(self):
        super().__init__()
        self.down = torch.nn.ModuleList([torch.nn.Conv2d(1, 3, 4, 2, 1), torch.nn.Conv2d(3, 8, 4, 2, 1)])
        self.up = torch.nn.ModuleList([torch.nn.ConvTranspose2d(8, 5, 4, 2, 1), torch.nn.ConvTranspose2d(8, 2, 4, 2, 1)])

    def forward(self, image):
        skip = self.down[0](image)
        x = self.up[0](torch.relu(self.down[1](torch.nn.functional.leaky_relu(skip, 0.2))))
        return torch.sigmoid(self.up[1](torch.relu(torch.cat([skip, x], 1))))


class OddKernels(torch.nn.Module):
    """Convolutions that keep the size, the image itself joined, one activation after another, two branches at the end."""

    def __init__(self):
        super().__init__()
        sides = ((1, 6, 5), (7, 4, 1), (4, 8, 7), (8, 1, 3), (7, 1, 3))
        self.convolutions = torch.nn.ModuleList([torch.nn.Conv2d(i, o, k, 1, k // 2) for i, o, k in sides])

    def forward(self, image):
        wide = torch.cat([image, torch.sigmoid(torch.nn.functional.leaky_relu(self.convolutions[0](image), 0.3))], 1)
        x = torch.relu(self.convolutions[2](torch.relu(self.convolutions[1](wide))))
        return torch.sigmoid(torch.cat([self.convolutions[3](x), self.convolutions[4](wide)], 1))


def two_channels(name, network, image, multiple, spread):
    """A network that no training makes: NAME.onnx, its card, and NAME_probability.npy, NAME_clean.npy."""
    torch.manual_seed(7)
    for tensor in network.parameters():
        torch.nn.init.normal_(tensor, 0, spread)
    padded = numpy.pad(image, [(0, -side % multiple) for side in image.shape], mode="reflect")
    batch = torch.from_numpy(padded / numpy.float32(255))[None, None]
    with torch.no_grad():
        output = network.eval()(batch)[0, :, :70, :50].numpy()
    sides = {2: "bins", 3: "beams"}
    torch.onnx.export(network, batch, HERE / f"{name}.onnx", opset_version=11, input_names=["image"],
                      output_names=["probability"], dynamic_axes={"image": sides, "probability": sides})
    card = {"schema": 1, "network": "unet", "input_range": [0.0, 1.0], "threshold": 0.5, "license": "BSD-3-Clause"}
    (HERE / f"{name}.json").write_text(json.dumps(card, indent=2) + "\n")
    for plane, suffix in zip(output, ("probability", "clean")):
        numpy.save(HERE / f"{name}_{suffix}.npy", numpy.ascontiguousarray(plane))
        print(name, suffix, float(plane.min()), float(plane.max()))


def main():
    image = numpy.random.default_rng(7).rayleigh(60, (70, 50)).clip(0, 255).astype(numpy.float32)
    numpy.save(HERE / "image.npy", image)
    two_channels("two_heads", TwoHeads(), image, 4, 0.25)
    two_channels("odd_kernels", OddKernels(), image, 1, 0.4)
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
