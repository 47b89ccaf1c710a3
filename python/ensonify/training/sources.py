"""Where pairs come from: datasets, folders of hand-labelled pairs, and the simulator itself.

A source gives frame n for n = 0, 1, 2 ... without end: its frames in an order of each epoch's own, a pure function of
(seed, n). Frames of validation are a list.
"""

import functools
import hashlib
import pathlib
import re
import typing

import numpy

from ensonify import ConfigError, DataError, Dataset, Recipe
from ensonify.data import EndlessFrames, FrameDataset

Array = typing.Any  # numpy arrays; Debian's numpy types need parameters that say nothing here


class Pair(typing.NamedTuple):
    """raw: float32 grey levels 0..255 [bins, beams]; mask: bool of the same shape; scene: what a split keeps apart; clean:
    as raw, without noise, where it was asked for."""

    raw: Array
    mask: Array
    scene: str
    clean: Array = None


class Source(typing.NamedTuple):
    """Training frames (`size` of them; None: no end), validation frames, and what the model's card says of them."""

    size: typing.Optional[int]
    frame: typing.Callable[[int], Pair]
    val: typing.Sequence[typing.Callable[[], Pair]]
    about: typing.Dict[str, typing.Any]


def frame_number(size: typing.Optional[int], seed: int, n: int) -> int:
    """Which of `size` frames comes n-th: every epoch is an order of its own."""
    return n if size is None else int(_order(size, seed, n // size)[n % size])


@functools.lru_cache(maxsize=2)
def _order(size: int, seed: int, epoch: int) -> Array:
    return numpy.random.default_rng([seed, 1, epoch]).permutation(size)


def _grey(raw: Array) -> Array:
    return raw.astype(numpy.float32) / numpy.float32(257) if raw.dtype == numpy.uint16 else raw.astype(numpy.float32)


def chosen_of(count: int, most: int) -> typing.List[int]:
    """At most `most` of `count` numbers, ascending; any fewer are among them. At random, the same each time: places take
    turns in a dataset, so that every n-th frame would be of few of them."""
    return sorted(numpy.random.default_rng(0).permutation(count)[:most].tolist())


def _fields(clean: bool) -> typing.Tuple[str, ...]:
    return ("raw", "mask", "clean") if clean else ("raw", "mask")


def _pair(sample: typing.Mapping[str, typing.Any], clean: bool) -> Pair:
    return Pair(_grey(sample["raw"]), sample["mask"] > 0, str(sample["place"]), _grey(sample["clean"]) if clean else None)


def dataset_source(folder: pathlib.Path, val: str, val_frames: int, most: typing.Optional[int], clean: bool) -> Source:
    """A dataset of `ensonify generate`: its train split, and the split `val`, which shares no place with it, or the split
    val of another dataset, where `val` is its folder."""
    elsewhere = (pathlib.Path(val) / "dataset.json").is_file()
    train = FrameDataset(folder, "train", fields=_fields(clean))
    held = FrameDataset(val, "val", fields=_fields(clean)) if elsewhere else FrameDataset(folder, val, fields=_fields(clean))
    manifest = Dataset(folder)
    size = min(len(train), most or len(train))
    chosen = chosen_of(len(train), size)

    def pair(frames: FrameDataset, number: int) -> Pair:
        return _pair(frames[number], clean)

    return Source(size, lambda n: pair(train, chosen[n]),
                  [functools.partial(pair, held, number) for number in chosen_of(len(held), val_frames)],
                  {"data": manifest.name, "root_hash": manifest.root_hash, "pairs": size, "val": val})


def recipe_source(recipe: str, seed: int, val_frames: int, clean: bool) -> Source:
    """Fresh frames of a recipe's train split, simulated as they are asked for; its val split as it stands."""
    endless = EndlessFrames(recipe, seed=seed, fields=_fields(clean))
    made = Recipe(recipe)
    first = 0
    for split, frames in made.splits.items():
        if split == "val":
            break
        first += frames
    else:
        raise ConfigError(f"recipe {recipe}: has no split 'val' to choose the model by; splits: {', '.join(made.splits)}")

    @functools.lru_cache(maxsize=256)
    def of_val(index: int) -> Pair:
        frame = made.make_frame(first + index)
        return _pair({name: getattr(frame, name) for name in (*_fields(clean), "place")}, clean)

    return Source(None, lambda n: _pair(endless.frame(n), clean), [functools.partial(of_val, i) for i in chosen_of(made.splits["val"], val_frames)],
                  {"data": f"fresh frames of recipe {made.name}", "seed": seed, "val": "val"})


def folder_source(folder: pathlib.Path, val: str, val_frames: int, most: typing.Optional[int]) -> Source:
    """raw/NAME.png and mask/NAME.png, 8 or 16 bits, mask above 0 where there is an echo.

    A scene is what NAME starts with, up to its last number (pier_007 is of pier). `val`: another such folder, or the
    share of the scenes that is held out, the last by name. A pair with a missing half is named.
    """
    pairs = _pairs_of(folder)
    if pathlib.Path(val).is_dir():
        held = [(pathlib.Path(val), name) for name in _pairs_of(pathlib.Path(val))]
    else:
        try:
            share = float(val)
        except ValueError:
            share = -1.0
        if not 0 < share < 1:
            raise ConfigError(f"--val '{val}': of a folder of pairs it must be a folder of pairs or a share between 0 and 1")
        scenes = sorted({_scene(name) for name in pairs})
        if len(scenes) < 2:
            raise ConfigError(f"{folder}: all pairs are of scene '{scenes[0]}', so that none can be held out; "
                              "name files SCENE_NUMBER.png, or give --val another folder")
        kept = set(scenes[:min(len(scenes) - 1, max(1, round(len(scenes) * (1 - share))))])
        held = [(folder, name) for name in pairs if _scene(name) not in kept]
        pairs = [name for name in pairs if _scene(name) in kept]
    pairs = [pairs[i] for i in chosen_of(len(pairs), most or len(pairs))]
    digest = hashlib.sha256()
    for name in pairs:
        digest.update(name.encode() + (folder / "raw" / name).read_bytes() + (folder / "mask" / name).read_bytes())
    return Source(len(pairs), lambda n: _read_pair(folder, pairs[n]),
                  [functools.partial(_read_pair, *held[i]) for i in chosen_of(len(held), val_frames)],
                  {"data": folder.name, "root_hash": digest.hexdigest(), "pairs": len(pairs), "val": val})


def _scene(name: str) -> str:
    return re.sub(r"[_\-. ]*\d+$", "", pathlib.Path(name).stem)


def _pairs_of(folder: pathlib.Path) -> typing.List[str]:
    halves = []
    for half in ("raw", "mask"):
        if not (folder / half).is_dir():
            raise DataError(f"{folder / half}: no such folder; a folder of pairs holds raw/ and mask/ with equal names")
        halves.append({file.name for file in (folder / half).glob("*.png")})
    for half, alone in (("mask", halves[0] - halves[1]), ("raw", halves[1] - halves[0])):
        if alone:
            raise DataError(f"{folder / half / min(alone)}: is missing, the other half of the pair is there"
                            + (f" (and {len(alone) - 1} more)" if len(alone) > 1 else ""))
    if not halves[0]:
        raise DataError(f"{folder}: raw/ and mask/ hold no .png")
    return sorted(halves[0])


@functools.lru_cache(maxsize=128)
def _read_pair(folder: pathlib.Path, name: str) -> Pair:
    raw, mask = _read_png(folder / "raw" / name), _read_png(folder / "mask" / name)
    if raw.shape != mask.shape:
        raise DataError(f"{folder / 'mask' / name}: is {mask.shape}, its raw image {raw.shape}; they must be alike")
    return Pair(_grey(raw), mask > 0, _scene(name))


def _read_png(path: pathlib.Path) -> Array:
    try:
        import PIL.Image  # type: ignore[import]
    except ImportError:
        raise ConfigError("PNG files are read by python3-pil, which is not installed") from None
    try:
        with PIL.Image.open(path) as image:
            pixels = numpy.asarray(image)
    except (OSError, SyntaxError, ValueError, PIL.Image.DecompressionBombError):
        raise DataError(f"{path}: no PNG file, or broken") from None
    if pixels.ndim != 2:
        raise DataError(f"{path}: has {pixels.shape[-1]} channels; images must be grey")
    if pixels.dtype == bool:
        return pixels.astype(numpy.uint8) * numpy.uint8(255)
    return pixels if pixels.dtype == numpy.uint8 else pixels.astype(numpy.uint16)
