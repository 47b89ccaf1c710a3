"""The command line. Every option is listed once, here."""

import argparse
import pathlib
import typing

from ensonify import ConfigError

from .networks import NAMES

# What a network's paper or our measurements set where the command line does not: ngf, batch, learning rate.
DEFAULTS = {"unet": (8, 8, 1e-3), "pix2pix": (64, 1, 2e-4)}

# These change neither the data nor the result, and may differ on --resume.
FREE = ("out", "resume", "threads", "workers")

EXAMPLE = """example:
  ensonify generate quick --out out/quick
  /usr/bin/python3 -m ensonify.training out/quick --steps 100 --every 50 --out out/model
  ensonify filter unet out/quick/test/raw out/masks --set model=out/model/model.onnx
"""


def _count(least: int) -> typing.Callable[[str], int]:
    def parse(text: str) -> int:
        if not text.isascii() or not text.isdigit() or not least <= int(text) <= 10**9:
            raise argparse.ArgumentTypeError(f"must be a whole number from {least} to 1000000000, not '{text}'")
        return int(text)
    return parse


def _rate(text: str) -> float:
    try:
        if 0 < float(text) <= 1:
            return float(text)
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"must be a number above 0, at most 1, not '{text}'")


def parse_options(words: typing.Optional[typing.Sequence[str]] = None) -> argparse.Namespace:
    """Options with their defaults filled in. Ends the program with 2 on wrong usage, as argparse does."""
    parser = argparse.ArgumentParser(
        prog="python3 -m ensonify.training", epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Train the learned filter: raw sonar image -> mask. Writes model.onnx with its card model.json, "
                    "checkpoint.pt, curves.csv and curves.png.")
    add = parser.add_argument
    add("data", help="dataset folder, folder with raw/ and mask/ PNG pairs, or a recipe (fresh frames from the simulator)")
    add("--out", type=pathlib.Path, required=True, help="folder for the model, the checkpoint and the curves")
    add("--model", choices=NAMES, default="unet", help="network and its training (default: %(default)s)")
    add("--clean", action="store_true", help="unet: a second head that estimates the clean image")
    add("--ngf", type=_count(1), help="channels of the first level (default: 8; pix2pix 64)")
    length = parser.add_mutually_exclusive_group()
    length.add_argument("--steps", type=_count(1), help="optimiser steps (default: 4000)")
    length.add_argument("--epochs", type=_count(1), help="instead: times through the training pairs")
    add("--batch", type=_count(1), help="crops of 256 x 256 a step (default: 8; pix2pix 1)")
    add("--crops", type=_count(1), default=4, help="crops of a frame, one after the other (default: %(default)s)")
    add("--lr", type=_rate, help="learning rate; falls to 0 over the second half (default: 1e-3; pix2pix 2e-4)")
    add("--seed", type=_count(0), default=0, help="of weights, frames and crops (default: %(default)s)")
    add("--pairs", type=_count(1), help="train on so many pairs only, drawn at random")
    add("--val", default="", help="a dataset's split (default: val), or another dataset, for its split val; of a folder of "
                                  "pairs: another one, or the share of its scenes that is held out (default: 0.2)")
    add("--val-frames", type=_count(1), default=60, help="at most so many frames, drawn at random (default: %(default)s)")
    add("--every", type=_count(1), default=250, help="steps between validations, each with a checkpoint (default: %(default)s)")
    add("--from", dest="start", type=pathlib.Path, metavar="MODEL", help="start from the best weights of this checkpoint.pt")
    add("--resume", action="store_true", help="go on with OUT/checkpoint.pt where there is one; same options, same result")
    add("--license", default="BSD-3-Clause", help="of the model, for its card (default: %(default)s)")
    add("--threads", type=_count(1), help="torch's threads (default: all cores); results differ in their last bits")
    add("--workers", type=_count(1), default=1, help="threads that make frames ahead (default: %(default)s)")
    options = parser.parse_args(words)
    ngf, batch, lr = DEFAULTS[options.model]
    options.ngf = options.ngf or ngf
    options.batch = options.batch or batch
    options.lr = options.lr or lr
    if options.clean and options.model != "unet":
        parser.error("--clean goes with --model unet")
    if not options.steps and not options.epochs:
        options.steps = 4000
    return options


def recorded(options: argparse.Namespace) -> typing.Dict[str, typing.Any]:
    """What a result depends on, as plain values."""
    return {name: str(value) if isinstance(value, pathlib.Path) else value
            for name, value in vars(options).items() if name not in FREE}


def check_same(options: argparse.Namespace, checkpoint: typing.Dict[str, typing.Any]) -> None:
    """Raises ConfigError where a training is resumed with other options."""
    for name, value in recorded(options).items():
        if checkpoint.get(name) != value:
            word = {"start": "--from", "data": "DATA"}.get(name, "--" + name.replace("_", "-"))
            raise ConfigError(f"{options.out / 'checkpoint.pt'}: was trained with {word} {checkpoint.get(name)}, not {value}; "
                              "give the same options to resume, or another --out")
