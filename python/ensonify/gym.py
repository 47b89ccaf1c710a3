"""The closed loop as a Gymnasium environment: your mapper or planner chooses where the vehicle looks next.

    env = ensonify.gym.ExploreEnv("test_tank")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(action)

Works without gymnasium; where it is installed, ExploreEnv is a gymnasium.Env with spaces.
"""

import importlib
import math
import typing

import numpy
import numpy.typing

from ._ensonify import ClosedLoop, Look

_gymnasium: typing.Any = None
_Env: typing.Any = object
try:
    _gymnasium = importlib.import_module("gymnasium")
    _Env = _gymnasium.Env
except ImportError:
    pass

Observation = typing.Dict[str, numpy.typing.NDArray[typing.Any]]
Info = typing.Dict[str, typing.Any]

COLOURS = numpy.array([[128, 128, 128], [255, 255, 255], [0, 0, 0]], dtype=numpy.uint8)


class ExploreEnv(_Env):  # type: ignore[misc]
    """One episode is one exploration.

    Action: float [3], forward, left and counter-clockwise turn in -1..1 of what one step allows, in the vehicle's frame.
    Observation: dict of `image` uint8 [bins, beams]; `pose` float32 [x, y, yaw] (m, rad) as the vehicle believes; `map`
    uint8 [window, window], north up and the vehicle in the middle: 0 unknown (and beyond the box), 1 free, 2 occupied.
    Reward: what coverage and boundary_found have grown by, and -1 where the vehicle touches something.
    Info: these scores, fpr, fnr, clearance_m, path_m, step, time_s, and the true `pose`, which no planner should use.
    Terminated: aground, or the share `goal` of the free columns is known. Truncated: `steps` pings were sent.
    All other arguments are those of ensonify.ClosedLoop.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 2}

    def __init__(self, scene: typing.Any, *, steps: int = 1000, goal: float = 0.95, window: int = 64,
                 render_mode: typing.Optional[str] = None, **loop: typing.Any) -> None:
        if window < 1 or not 0 < goal <= 1:
            raise ValueError("window must be at least 1 and goal in (0, 1]")
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode '{render_mode}' is none of rgb_array, None")
        self.loop = ClosedLoop(scene, steps=steps, **loop)
        self.steps, self.goal, self.window, self.render_mode = steps, goal, window, render_mode
        self._look: typing.Optional[Look] = None
        self._over = True
        self._seeds = numpy.random.default_rng()
        if _gymnasium is not None:
            box, sonar = _gymnasium.spaces.Box, self.loop.sonar
            self.action_space = box(-1, 1, (3,), numpy.float32)
            self.observation_space = _gymnasium.spaces.Dict({
                "image": box(0, 255, (sonar.range_bins, sonar.beams), numpy.uint8),
                "pose": box(-numpy.inf, numpy.inf, (3,), numpy.float32),
                "map": box(0, 2, (window, window), numpy.uint8)})

    def reset(self, *, seed: typing.Optional[int] = None,
              options: typing.Optional[Info] = None) -> typing.Tuple[Observation, Info]:
        """A new episode. The same seed gives the same one; without, episodes differ, by the last seed given."""
        if options:
            raise ValueError(f"options: {', '.join(options)}: there are none; what differs goes to the constructor")
        if seed is not None:
            self._seeds = numpy.random.default_rng(seed)
        self.loop.reset(int(self._seeds.integers(2**53)) if seed is None else seed)
        self._over = False
        self._look = self.loop.look()
        return self._observation(self._look), self._info(self._look)

    def step(self, action: numpy.typing.ArrayLike) -> typing.Tuple[Observation, float, bool, bool, Info]:
        """Moves, pings, maps. Raises RuntimeError once the episode is over, ValueError for an action that is none."""
        if self._over or self._look is None:
            raise RuntimeError("the episode is over: call reset()")
        share = numpy.asarray(action, dtype=numpy.float64)
        if share.shape != (3,) or not numpy.isfinite(share).all():
            raise ValueError("action must be three finite numbers: forward, left, turn")
        step_m, step_rad = self.loop.steps_m_rad
        forward, left, turn = numpy.clip(share, -1, 1) * (step_m, step_m, step_rad)
        x, y, yaw = self._planar(self._look)
        before = self._look.scores
        self.loop.move((x + forward * math.cos(yaw) - left * math.sin(yaw),
                        y + forward * math.sin(yaw) + left * math.cos(yaw), yaw + turn))
        look = self._look = self.loop.look()
        scores = look.scores
        aground = scores["clearance_m"] <= 0
        reward = (scores["coverage"] - before["coverage"] + _grown(before["boundary_found"], scores["boundary_found"])
                  - (1.0 if aground else 0.0))
        terminated = aground or scores["coverage"] >= self.goal
        truncated = look.step + 1 >= self.steps
        self._over = terminated or truncated
        return self._observation(look), float(reward), bool(terminated), bool(truncated), self._info(look)

    def render(self) -> typing.Optional[numpy.typing.NDArray[numpy.uint8]]:
        """The believed map, north up, uint8 [height, width, 3]: grey unknown, white free, black occupied."""
        if self.render_mode is None or self._look is None:
            return None
        picture: numpy.typing.NDArray[numpy.uint8] = COLOURS[self._look.columns[::-1]]
        return picture

    def close(self) -> None:
        self.loop.close()
        self._over = True
        self._look = None

    @staticmethod
    def _planar(look: Look) -> typing.Tuple[float, float, float]:
        pose = look.pose_est
        return float(pose[0, 3]), float(pose[1, 3]), math.atan2(pose[1, 0], pose[0, 0])

    def _observation(self, look: Look) -> Observation:
        x, y, yaw = self._planar(look)
        origin, cell = self.loop.columns_origin_m, self.loop.resolution_m
        row, column = math.floor((y - origin[1]) / cell), math.floor((x - origin[0]) / cell)
        return {"image": look.raw, "pose": numpy.array([x, y, yaw], dtype=numpy.float32),
                "map": _cut(look.columns, row, column, self.window)[::-1].copy()}

    def _info(self, look: Look) -> Info:
        return {**look.scores, "step": look.step, "time_s": look.time_s, "pose": look.pose}


def _grown(before: float, after: float) -> float:
    """Without a boundary its share is NaN."""
    return 0.0 if math.isnan(before) or math.isnan(after) else after - before


def _cut(columns: numpy.typing.NDArray[numpy.uint8], row: int, column: int,
         window: int) -> numpy.typing.NDArray[numpy.uint8]:
    """A square of so many columns about one; 0 beyond the border."""
    cut = numpy.zeros((window, window), dtype=numpy.uint8)
    top, left = row - window // 2, column - window // 2
    y0, y1 = max(top, 0), min(top + window, columns.shape[0])
    x0, x1 = max(left, 0), min(left + window, columns.shape[1])
    if y0 < y1 and x0 < x1:
        cut[y0 - top:y1 - top, x0 - left:x1 - left] = columns[y0:y1, x0:x1]
    return cut
