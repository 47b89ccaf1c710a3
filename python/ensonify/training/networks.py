"""The networks: one U-Net in two settings, and the discriminator that trains the second.

Images are float32 [batch, 1, bins, beams]; both sides a multiple of 2**depth. Their output is [batch, heads, bins, beams].
`unet`: sigmoid of head 0 is the probability of an echo, sigmoid of head 1, where it is there, the clean image (0..1).
`pix2pix` (Isola et al. 2017): its tanh lies in -1..1, and (tanh(z) + 1) / 2 = sigmoid(2 z).
"""

import copy
import dataclasses
import typing

import torch
from torch import nn

NAMES = ("unet", "pix2pix")


@dataclasses.dataclass(frozen=True)
class NetworkKind:
    """What is built from a checkpoint's or a command line's words."""

    name: str
    ngf: int
    clean: bool = False

    @property
    def heads(self) -> int:
        return 2 if self.clean else 1

    @property
    def depth(self) -> int:
        """Halvings of the image: 8 as published, 6 where the sides need not be multiples of 256."""
        return 8 if self.name == "pix2pix" else 6

    @property
    def widths(self) -> typing.List[int]:
        """Channels by level: ngf doubled at each, up to 8 ngf as published, up to 4 ngf in `unet`."""
        return [self.ngf * min(2**i, 8 if self.name == "pix2pix" else 4) for i in range(self.depth)]

    @property
    def input_range(self) -> typing.Tuple[float, float]:
        """What grey levels 0 and 255 become."""
        return (-1.0, 1.0) if self.name == "pix2pix" else (0.0, 1.0)

    @property
    def gain(self) -> float:
        """probability = sigmoid(gain * output)."""
        return 2.0 if self.name == "pix2pix" else 1.0


class UNet(nn.Module):
    """k4 s2 convolutions down and up with concatenated skips. Gives one number a head and pixel, before any sigmoid or tanh.

    Of `kind` pix2pix: dropout in the three blocks that follow the innermost, as published. Of `kind` unet: a 3x3
    convolution at half resolution before the last one, because what decides a pixel is no sum of what decides its
    neighbourhood and what its own level says (in 500 steps 1.8 dB more in the clean image). `folded`: no normalisation, but
    biases where it stood.
    """

    def __init__(self, kind: NetworkKind, folded: bool = False) -> None:
        super().__init__()
        widths = kind.widths
        joins = kind.name == "unet"
        inner = kind.depth - 1
        self.down = nn.ModuleList()
        self.up = nn.ModuleList()
        for i, width in enumerate(widths):
            before = 1 if i == 0 else widths[i - 1]
            normed = 0 < i < inner
            self.down.append(nn.Conv2d(before, width, 4, 2, 1, bias=folded and normed))
            below = width if i == inner or (i == 0 and joins) else 2 * width
            above = kind.heads if i == 0 else widths[i - 1]
            self.up.append(nn.ConvTranspose2d(below, above, 4, 2, 1, bias=folded or i == 0))
        self.join = nn.Conv2d(2 * widths[0], widths[0], 3, 1, 1) if joins else nn.Identity()
        # Index i is the level: down_norm follows down[i], up_norm follows up[i].
        self.down_norm = nn.ModuleList(
            nn.BatchNorm2d(w) if 0 < i < inner and not folded else nn.Identity() for i, w in enumerate(widths))
        self.up_norm = nn.ModuleList(
            nn.BatchNorm2d(widths[i - 1]) if i > 0 and not folded else nn.Identity() for i in range(kind.depth))
        drops = kind.name == "pix2pix" and not folded
        self.drop = nn.ModuleList(
            nn.Dropout(0.5) if drops and inner - 3 <= i < inner else nn.Identity() for i in range(kind.depth))

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        skips = []
        x = image
        for i, (down, norm) in enumerate(zip(self.down, self.down_norm)):
            x = norm(down(x if i == 0 else nn.functional.leaky_relu(x, 0.2)))
            skips.append(x)
        for i in reversed(range(len(self.up))):
            if i < len(self.up) - 1:
                x = torch.cat([skips[i], x], 1)
            x = nn.functional.relu(x)
            if i == 0 and not isinstance(self.join, nn.Identity):
                x = nn.functional.relu(self.join(x))
            x = self.drop[i](self.up_norm[i](self.up[i](x)))
        return x


class PatchDiscriminator(nn.Module):
    """70x70 PatchGAN on (input, output) pairs: a logit a patch, high for true masks. 2.77 M parameters."""

    def __init__(self, ndf: int = 64) -> None:
        super().__init__()
        layers: typing.List[nn.Module] = [nn.Conv2d(2, ndf, 4, 2, 1), nn.LeakyReLU(0.2)]
        for before, width, stride in ((ndf, 2 * ndf, 2), (2 * ndf, 4 * ndf, 2), (4 * ndf, 8 * ndf, 1)):
            layers += [nn.Conv2d(before, width, 4, stride, 1, bias=False), nn.BatchNorm2d(width), nn.LeakyReLU(0.2)]
        self.layers = nn.Sequential(*layers, nn.Conv2d(8 * ndf, 1, 4, 1, 1))

    def forward(self, image: torch.Tensor, output: torch.Tensor) -> torch.Tensor:
        return typing.cast(torch.Tensor, self.layers(torch.cat([image, output], 1)))


def init_as_published(network: nn.Module) -> None:
    """Weights from N(0, 0.02), of normalisations from N(1, 0.02), no biases."""
    for part in network.modules():
        if isinstance(part, (nn.Conv2d, nn.ConvTranspose2d)):
            nn.init.normal_(part.weight, 0.0, 0.02)
            if part.bias is not None:
                nn.init.zeros_(part.bias)
        elif isinstance(part, nn.BatchNorm2d):
            nn.init.normal_(part.weight, 1.0, 0.02)
            nn.init.zeros_(part.bias)


def make_network(kind: NetworkKind) -> UNet:
    network = UNet(kind)
    if kind.name == "pix2pix":
        init_as_published(network)
    return network


def folded(network: UNet, kind: NetworkKind) -> nn.Module:
    """The network that is used, on the CPU: normalisation by the running statistics folded into the weights, no dropout,
    and the probability of an echo as its output."""
    network = copy.deepcopy(network).cpu()  # a GPU rounds in other ways
    result = UNet(kind, folded=True)
    with torch.no_grad():
        for i in range(kind.depth):
            _fold(network.down[i], network.down_norm[i], result.down[i], 0)
            _fold(network.up[i], network.up_norm[i], result.up[i], 1)
        result.join.load_state_dict(network.join.state_dict())
        last: typing.Any = result.up[0]
        last.weight.mul_(kind.gain)
        last.bias.mul_(kind.gain)
    return nn.Sequential(result, nn.Sigmoid()).eval()


def _fold(conv: typing.Any, norm: typing.Any, into: typing.Any, out_axis: int) -> None:
    into.weight.copy_(conv.weight)
    if isinstance(norm, nn.BatchNorm2d):
        mean, var = (typing.cast(torch.Tensor, statistic) for statistic in (norm.running_mean, norm.running_var))
        scale = norm.weight / torch.sqrt(var + norm.eps)
        shape = [1, 1, 1, 1]
        shape[out_axis] = -1
        into.weight.mul_(scale.view(shape))
        into.bias.copy_(norm.bias - mean * scale)
    elif conv.bias is not None:
        into.bias.copy_(conv.bias)
