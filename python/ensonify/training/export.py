"""The model as the C++ program reads it: model.onnx and its card model.json. Format: docs/learned_filter.md."""

import hashlib
import io
import json
import pathlib
import typing
import warnings

import torch

from .files import whole_file
from .networks import NetworkKind, UNet, folded

OPSET = 11


def onnx_bytes(network: UNet, kind: NetworkKind) -> bytes:
    """Input `image` float32 [1, 1, bins, beams] on the input range, output `heads` [1, 1 or 2, bins, beams], 0..1."""
    used = folded(network, kind)
    _tell_apart(list(used.parameters()))
    example = torch.zeros(1, 1, 2**kind.depth, 2**kind.depth)
    file = io.BytesIO()
    sides = {2: "bins", 3: "beams"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(used, example, file, opset_version=OPSET, input_names=["image"],
                          output_names=["heads"], dynamic_axes={"image": sides, "heads": sides})
    return file.getvalue()


def _tell_apart(tensors: typing.Sequence[torch.Tensor]) -> None:
    """Moves tensors that are alike, as biases of untrained networks are, by one bit: torch would write them once and refer
    to them by Identity nodes, which the program does not read."""
    seen: typing.List[torch.Tensor] = []
    with torch.no_grad():
        for tensor in tensors:
            while any(torch.equal(tensor, other) for other in seen):
                tensor.copy_(torch.nextafter(tensor, torch.full_like(tensor, torch.inf)))
            seen.append(tensor)


def write_model(folder: pathlib.Path, network: UNet, kind: NetworkKind, *, threshold: float, license: str,
                metrics: typing.Dict[str, typing.Any], training: typing.Dict[str, typing.Any]) -> None:
    """model.onnx first: a card never stands beside a model that is not there."""
    model = onnx_bytes(network, kind)
    card = {
        "schema": 1,
        "network": kind.name,
        "heads": ["echo", "clean"] if kind.clean else ["echo"],
        "ngf": kind.ngf,
        "parameters": sum(p.numel() for p in folded(network, kind).parameters()),
        "sha256": hashlib.sha256(model).hexdigest(),
        "input_range": list(kind.input_range),
        "threshold": threshold,
        "license": license,
        "metrics": metrics,
        "training": training,
    }
    with whole_file(folder / "model.onnx") as beside:
        beside.write_bytes(model)
    with whole_file(folder / "model.json") as beside:
        beside.write_text(json.dumps(card, indent=2) + "\n")
