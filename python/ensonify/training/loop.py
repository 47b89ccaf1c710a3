"""A whole training: steps, validations, the best model, checkpoints."""

import argparse
import math
import pathlib
import sys
import time
import typing

import torch

from ensonify import ConfigError, __version__, recipe_names

from .batches import batches
from .curves import Row, write_curves
from .export import write_model
from .files import load_checkpoint, save_checkpoint
from .networks import NetworkKind, make_network
from .options import check_same, recorded
from .scores import Scores, validate
from .sources import Source, dataset_source, folder_source, recipe_source
from .trainers import Trainer, make_trainer


def open_source(options: argparse.Namespace) -> Source:
    """Which of the three kinds the words name. Raises ConfigError, DataError."""
    folder = pathlib.Path(options.data)
    if (folder / "dataset.json").is_file():
        return dataset_source(folder, options.val or "val", options.val_frames, options.pairs, options.clean)
    if folder.is_dir():
        if options.clean:
            raise ConfigError(f"{folder}: pairs hold no clean images; --clean goes with a dataset of ensonify or a recipe")
        return folder_source(folder, options.val or "0.2", options.val_frames, options.pairs)
    if folder.suffix not in (".yaml", ".yml") and options.data not in recipe_names():
        raise ConfigError(f"{options.data}: neither a folder nor a recipe; bundled recipes: {', '.join(recipe_names())}")
    if options.pairs or options.epochs or options.val:
        raise ConfigError("--pairs, --epochs and --val go with a folder: a recipe's frames have no end, and it says what val is")
    return recipe_source(options.data, options.seed, options.val_frames, options.clean)


def steps_of(options: argparse.Namespace, source: Source) -> int:
    if options.epochs and source.size:
        return math.ceil(int(options.epochs) * source.size * int(options.crops) / int(options.batch))
    return int(options.steps)


def lr_share(step: int, steps: int) -> float:
    """1 over the first half, then linearly to 0: the published 100 + 100 epochs."""
    return min(1.0, 2 * (1 - step / steps))


class Line:
    """One line of progress: rewritten on a terminal, else one at each validation."""

    def __init__(self, first: int, steps: int) -> None:
        self._first, self._steps = first, steps
        self._start = self._shown = time.monotonic()

    def show(self, step: int, text: str, lasting: bool = False) -> None:
        now = time.monotonic()
        if not lasting and (not sys.stderr.isatty() or now - self._shown < 0.5):
            return
        self._shown = now
        rate = (step - self._first) / max(now - self._start, 1e-9)
        left_s = round((self._steps - step) / rate) if rate else 0
        eta = f"{left_s // 3600}:{left_s // 60 % 60:02}:{left_s % 60:02}"
        line = f"step {step}/{self._steps}  {rate:.2f}/s  ETA {eta}  {text}"
        if sys.stderr.isatty():
            line = f"\r\x1b[K{line}"
        print(line, end="\n" if lasting else "", file=sys.stderr, flush=True)


def train(options: argparse.Namespace) -> Scores:
    """Trains as the options say and returns the best model's scores. Raises ConfigError, DataError."""
    torch.set_num_threads(options.threads or torch.get_num_threads())
    torch.backends.cudnn.deterministic = True
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    kind = NetworkKind(options.model, options.ngf, options.clean)
    file = options.out / "checkpoint.pt"
    if file.exists() and not options.resume:
        raise ConfigError(f"{file}: a training is already there; --resume goes on with it, another --out begins one")
    source = open_source(options)
    steps = steps_of(options, source)
    torch.manual_seed(options.seed)
    trainer = make_trainer(kind, device, options.lr)
    first, rows, best = 0, [], {}  # type: int, typing.List[Row], typing.Dict[str, typing.Any]
    if options.start:
        start_from(options.start, kind, trainer)
    if file.exists():
        state = load_checkpoint(file)
        check_same(options, state["options"])
        trainer.load(state["trainer"])
        first, rows, best = state["step"], state["rows"], state["best"]
    options.out.mkdir(parents=True, exist_ok=True)

    made = batches(source, kind, size=options.batch, per_frame=options.crops, seed=options.seed, first_step=first,
                   workers=options.workers)
    line = Line(first, steps)
    total = 0.0
    since = 0
    for step in range(first, steps):
        batch = next(made)
        torch.manual_seed(options.seed * 1_000_003 + step)  # of dropout
        losses = trainer.step(batch.to(device), lr_share(step, steps))
        total += losses["loss"]
        since += 1
        line.show(step + 1, "  ".join(f"{name} {value:.4f}" for name, value in losses.items()))
        if (step + 1) % options.every and step + 1 < steps:
            continue
        scores = validate(trainer.network, kind, source.val, device)
        rows.append({"step": step + 1, "loss": total / since, "iou": scores.iou, "f1": scores.f1,
                     "precision": scores.precision, "recall": scores.recall, "threshold": scores.threshold,
                     **({"clean_psnr_db": scores.clean_psnr_db} if kind.clean else {})})
        line.show(step + 1, f"loss {total / since:.4f}  val IoU {scores.iou:.4f}  F1 {scores.f1:.4f}"
                  + (f"  clean {scores.clean_psnr_db:.2f} dB" if kind.clean else ""), lasting=True)
        total, since = 0.0, 0
        if not best or scores.iou > best["iou"]:
            weights = {name: tensor.cpu().clone() for name, tensor in trainer.network.state_dict().items()}
            best = {**scores._asdict(), "step": step + 1, "network": weights}
            write_best(options, kind, best, source, steps)
        write_curves(options.out, rows)
        save_checkpoint(file, {"options": recorded(options), "trainer": trainer.state(), "step": step + 1, "rows": rows,
                               "best": best})
    return Scores(*(best[field] for field in Scores._fields))


def start_from(file: pathlib.Path, kind: NetworkKind, trainer: Trainer) -> None:
    """Fine-tuning: the best weights of another training of the same network."""
    state = load_checkpoint(file)
    theirs = NetworkKind(state["options"]["model"], state["options"]["ngf"], state["options"]["clean"])
    if theirs != kind:
        raise ConfigError(f"{file}: is {theirs}, not {kind}; give the same --model, --ngf and --clean")
    trainer.network.load_state_dict(state["best"]["network"])


def write_best(options: argparse.Namespace, kind: NetworkKind, best: typing.Dict[str, typing.Any], source: Source,
               steps: int) -> None:
    network = make_network(kind)
    network.load_state_dict(best["network"])
    metrics = {name: best[name] for name in Scores._fields if name != "threshold" and best[name] is not None}
    settings = {k: v for k, v in recorded(options).items() if k not in ("model", "ngf", "license")}
    training = {**settings, **source.about, "steps": steps, "best_step": best["step"], "ensonify": __version__,
                "torch": torch.__version__}
    write_model(options.out, network, kind, threshold=best["threshold"], license=options.license,
                metrics={**metrics, "of": f"validation, {len(source.val)} frames"}, training=training)
