#!/usr/bin/python3
"""A mapper of one's own in the closed loop: own_mapper.py [STEPS]

Every ping goes to `Backprojection`, whose map is scored and planned on instead of ours; our planner chooses the way.
"""

import sys

import numpy

import ensonify

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 25


class Backprojection:
    """Marks what echoes at the sonar's depth, frees what lies before the first echo of a beam; yours may do better."""

    def __init__(self, loop):
        self.sonar, self.cell = loop.sonar, loop.resolution_m
        self.origin = numpy.array(loop.columns_origin_m)
        self.log_odds = None

    def __call__(self, look):
        if self.log_odds is None:
            self.log_odds = numpy.zeros(look.columns.shape, numpy.float32)
        ys, xs = numpy.indices(self.log_odds.shape)
        centres = self.origin + self.cell * (numpy.stack([xs, ys], -1) + 0.5)
        dx, dy = (centres - look.pose_est[:2, 3]).transpose(2, 0, 1)
        bearing = numpy.arctan2(dy, dx) - numpy.arctan2(look.pose_est[1, 0], look.pose_est[0, 0])
        bearing = (bearing + numpy.pi) % (2 * numpy.pi) - numpy.pi
        row = numpy.searchsorted(self.sonar.range_m, numpy.hypot(dx, dy))
        column = numpy.searchsorted(-self.sonar.azimuth_rad, -bearing)
        seen = (row < self.sonar.range_bins) & (row > 0) & (column > 0) & (column < self.sonar.beams)
        row, column = row[seen], column[seen]
        echo = look.filtered >= 60
        first = numpy.where(echo.any(axis=0), echo.argmax(axis=0), self.sonar.range_bins)
        # A cell is wider than a bin: it echoes where one of its bins does.
        bins = max(1, round(self.cell / (self.sonar.range_m[1] - self.sonar.range_m[0])) // 2)
        nearby = sum(numpy.roll(echo, k, axis=0) for k in range(-bins, bins + 1)) > 0
        change = numpy.where(nearby[row, column], 0.8, numpy.where(row < first[column], -0.4, 0))
        self.log_odds[seen] = numpy.clip(self.log_odds[seen] + change, -4, 4)
        z = float(look.pose_est[2, 3])
        return {"map": ensonify.Map(self.log_odds[None], [*self.origin, z], self.cell)}


loop = ensonify.ClosedLoop("test_tank")
for name, guest in (("ours", None), ("yours", Backprojection(loop))):
    last = loop.explore(guest, steps=steps, seed=1).steps[-1]
    print(f"{name:6s} after {last['step'] + 1} pings: coverage {last['coverage']:.3f}, boundary found "
          f"{last['boundary_found']:.3f}, FPR {last['fpr']:.3f}, FNR {last['fnr']:.3f}, {last['path_m']:.1f} m")
