#!/usr/bin/python3
"""A ping at the breakwater, as the instrument shows it and as it would be without noise: first_ping.py [FOLDER]"""

import pathlib
import sys

import numpy

import ensonify

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/first_ping")
simulator = ensonify.Simulator("breakwater", "oculus_m1200d_hf", "oculus_open_water")
ping = simulator.ping(ensonify.pose(-0.5, 0.6, -1.79, pitch_deg=7.8, yaw_deg=80), seed=1)

bins, beams = numpy.nonzero(ping.mask)
nearest_m = ping.sonar.range_m[bins.min()]
print(f"{ping.mask.mean() / 2.55:.1f} % of the pixels are echoes, the nearest at {nearest_m:.2f} m")

ensonify.save_png(out / "raw.png", ping.raw)
ensonify.save_png(out / "fan.png", ensonify.fan_view(ping.raw, ping.sonar))
ensonify.save_png(out / "place.png", ensonify.draw_scene(simulator.scene))
print(f"pictures in {out}")
