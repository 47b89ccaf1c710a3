"""Simulates multibeam imaging sonars on the CPU.

    import ensonify
    simulator = ensonify.Simulator("breakwater", "oculus_m1200d_hf")
    ping = simulator.ping(ensonify.pose(-0.5, 0.6, -1.79, pitch_deg=7.8, yaw_deg=80), seed=1)
    ping.raw, ping.clean, ping.mask       # numpy arrays [bins, beams]

World: metres, east north up, z = 0 at the water surface. Sonar: x forward, y left, z up. Images: rows = range bins,
nearest first; columns = beams, port first. What a name stands for may be a bundled name, a YAML file, or a dict of the
file's keys. `ensonify.data` has datasets for training, `ensonify.gym` an environment for mappers and planners.
"""

import functools as _functools
import importlib as _importlib
import os as _os
import typing as _typing

from . import _ensonify
from ._ensonify import (
    ClosedLoop, ConfigError, DataError, Dataset, DiskError, Filter, Frame, Grid, Look, Map, Mapper, Noise, Ping,
    Recipe, Run, Scene, Simulator, Sonar, __version__, draw_scene, fan_view, filter_names, noise_names, polar_view,
    pose, recipe_names, roll_pitch_yaw_deg, save_png, scene_names, score_image, score_map, score_mask, set_threads,
    sonar_names, voxelize)

if _typing.TYPE_CHECKING:
    from . import data, gym

__all__ = [
    "ClosedLoop", "ConfigError", "DataError", "Dataset", "DiskError", "Filter", "Frame", "Grid", "Look", "Map",
    "Mapper", "Noise", "Ping", "Recipe", "Run", "Scene", "Simulator", "Sonar", "__version__", "config", "data",
    "draw_scene", "fan_view", "filter_names", "gym", "make_frame", "noise_names", "open_dataset", "polar_view", "pose",
    "recipe_names", "roll_pitch_yaw_deg", "save_png", "scene_names", "score_image", "score_map", "score_mask", "set_threads",
    "sonar_names", "voxelize"]

for _thing in vars(_ensonify).copy().values():
    if getattr(_thing, "__module__", None) == "ensonify._ensonify":
        _thing.__module__ = "ensonify"
del _thing

# Threads do not survive a fork: those of the pool end before it, and start again where they are needed.
_os.register_at_fork(before=_ensonify._end_threads)

_KINDS = {"scene": "scenes", "sonar": "sensor_models", "noise": "noise", "recipe": "generators", "filter": "filters"}


def open_dataset(folder: "str | _os.PathLike[str]") -> Dataset:
    """Opens a finished dataset, folder or WebDataset. Raises DataError. For training see `ensonify.data`."""
    return Dataset(folder)


def make_frame(recipe: "Recipe | str | _os.PathLike[str]", index: int) -> Frame:
    """Frame `index` of a recipe: the bits that `ensonify generate` writes. A name's places are kept for the next call."""
    return (recipe if isinstance(recipe, Recipe) else _recipe(_os.fspath(recipe), _os.getpid())).make_frame(index)


@_functools.lru_cache(maxsize=1)
def _recipe(source: str, _process: int) -> Recipe:
    return Recipe(source)


def config(kind: str, name: "str | _os.PathLike[str]") -> "dict[str, _typing.Any]":
    """A bundled or own YAML file as a dict, to be changed and given to Scene, Sonar, Noise, Recipe or Filter.

    `kind`: scene, sonar, noise, recipe or filter. Paths in it stay as they are written. Needs python3-yaml.
    """
    import yaml  # type: ignore[import]

    if kind not in _KINDS:
        raise ConfigError(f"kind '{kind}' is none of {', '.join(_KINDS)}")
    with open(_ensonify._config_path(_KINDS[kind], _os.fspath(name)), encoding="utf-8") as file:
        loaded = yaml.safe_load(file)
    if not isinstance(loaded, dict):
        raise ConfigError(f"{name}: is no mapping of keys to values")
    return loaded


def __getattr__(name: str) -> _typing.Any:
    # torch and gymnasium, where they are there, take seconds to load: only who asks for them waits.
    if name in ("data", "gym"):
        return _importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module 'ensonify' has no attribute '{name}'")
