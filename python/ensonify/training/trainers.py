"""One step of training: unet by cross-entropy, soft Dice and PSNR, pix2pix against its discriminator as published."""

import math
import typing

import torch
from torch import nn

from .batches import Batch
from .networks import NetworkKind, PatchDiscriminator, UNet, init_as_published, make_network

Losses = typing.Dict[str, float]
State = typing.Dict[str, typing.Any]


class UNetTrainer:
    """Adam on binary cross-entropy + 1 - soft Dice of the mask's logits; with a clean head, plus 0.1 times the mean of
    ln(mean squared error) over the crops, which is what the mean PSNR measures."""

    CLEAN_WEIGHT = 0.1
    LEAST_MSE = 1e-6  # 60 dB: empty crops are learned to no more than that

    def __init__(self, kind: NetworkKind, device: torch.device, lr: float) -> None:
        self.lr = lr
        self.network: UNet = make_network(kind).to(device)
        self._optimiser = torch.optim.Adam(self.network.parameters(), lr)

    def step(self, batch: Batch, lr_share: float) -> Losses:
        """`lr_share`: of the learning rate."""
        _set_rate(self._optimiser, self.lr * lr_share)
        self.network.train()
        heads = self.network(batch.image)
        logits = heads[:, :1]
        entropy = nn.functional.binary_cross_entropy_with_logits(logits, batch.mask)
        share = torch.sigmoid(logits)
        dice = (2 * (share * batch.mask).sum() + 1) / (share.sum() + batch.mask.sum() + 1)
        loss = entropy + 1 - dice
        losses = {"bce": float(entropy), "dice": float(1 - dice)}
        if batch.clean is not None:
            mse = ((torch.sigmoid(heads[:, 1:]) - batch.clean) ** 2).mean((1, 2, 3))
            log_mse = torch.log(mse + self.LEAST_MSE).mean()
            loss = loss + self.CLEAN_WEIGHT * log_mse
            losses["clean_db"] = float(log_mse) * -10 / math.log(10)
        _descend(self._optimiser, loss)
        return {"loss": float(loss), **losses}

    def state(self) -> State:
        return {"network": self.network.state_dict(), "optimiser": self._optimiser.state_dict()}

    def load(self, state: State) -> None:
        self.network.load_state_dict(state["network"])
        self._optimiser.load_state_dict(state["optimiser"])


class Pix2PixTrainer:
    """Isola et al. 2017: discriminator on half the cross-entropy, then generator on cross-entropy + 100 L1; Adam with
    betas .5, .999."""

    L1_WEIGHT = 100.0

    def __init__(self, kind: NetworkKind, device: torch.device, lr: float) -> None:
        self.lr = lr
        self.network: UNet = make_network(kind).to(device)
        self._discriminator = PatchDiscriminator().to(device)
        init_as_published(self._discriminator)
        betas = (0.5, 0.999)
        self._optimiser = torch.optim.Adam(self.network.parameters(), lr, betas)
        self._discriminator_optimiser = torch.optim.Adam(self._discriminator.parameters(), lr, betas)

    def step(self, batch: Batch, lr_share: float) -> Losses:
        for optimiser in (self._optimiser, self._discriminator_optimiser):
            _set_rate(optimiser, self.lr * lr_share)
        self.network.train()
        target = batch.mask * 2 - 1
        output = torch.tanh(self.network(batch.image))

        judged = _verdict(self._discriminator(batch.image, target), True)
        judged = (judged + _verdict(self._discriminator(batch.image, output.detach()), False)) / 2
        _descend(self._discriminator_optimiser, judged)

        self._discriminator.requires_grad_(False)
        fooled = _verdict(self._discriminator(batch.image, output), True)
        away = nn.functional.l1_loss(output, target)
        loss = fooled + self.L1_WEIGHT * away
        _descend(self._optimiser, loss)
        self._discriminator.requires_grad_(True)
        return {"loss": float(loss), "gan": float(fooled), "l1": float(away), "discriminator": float(judged)}

    def state(self) -> State:
        return {"network": self.network.state_dict(), "optimiser": self._optimiser.state_dict(),
                "discriminator": self._discriminator.state_dict(),
                "discriminator_optimiser": self._discriminator_optimiser.state_dict()}

    def load(self, state: State) -> None:
        self.network.load_state_dict(state["network"])
        self._optimiser.load_state_dict(state["optimiser"])
        self._discriminator.load_state_dict(state["discriminator"])
        self._discriminator_optimiser.load_state_dict(state["discriminator_optimiser"])


Trainer = typing.Union[UNetTrainer, Pix2PixTrainer]


def make_trainer(kind: NetworkKind, device: torch.device, lr: float) -> Trainer:
    return Pix2PixTrainer(kind, device, lr) if kind.name == "pix2pix" else UNetTrainer(kind, device, lr)


def _verdict(logits: torch.Tensor, true: bool) -> torch.Tensor:
    return nn.functional.binary_cross_entropy_with_logits(logits, torch.full_like(logits, float(true)))


def _descend(optimiser: torch.optim.Optimizer, loss: torch.Tensor) -> None:
    optimiser.zero_grad(set_to_none=True)
    loss.backward()  # type: ignore[no-untyped-call]
    optimiser.step()


def _set_rate(optimiser: torch.optim.Optimizer, lr: float) -> None:
    for group in optimiser.param_groups:
        group["lr"] = lr
