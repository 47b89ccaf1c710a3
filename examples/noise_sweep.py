#!/usr/bin/python3
"""How a filter copes as noise grows: PSNR and mask IoU over one parameter of a noise profile: noise_sweep.py [FOLDER]"""

import pathlib
import sys

import numpy

import ensonify

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/noise_sweep")
scene, sonar = ensonify.Scene("test_tank"), ensonify.Sonar("oculus_m1200d_hf", range_bins=512)
noise = ensonify.Noise("paper").to_dict()
pose = ensonify.pose(1, 0, -1.5, pitch_deg=10)
lee = ensonify.Filter("lee", window=7, cu=0.5)

strip = []
print("sigma  PSNR raw  PSNR lee  IoU raw  IoU lee")
for sigma in (0.02, 0.05, 0.1, 0.2):
    noise["stages"][1]["sigma"] = sigma  # additive_rayleigh, after gaussian_speckle
    ping = ensonify.Simulator(scene, sonar, noise).ping(pose, seed=1)
    filtered = lee(ping.raw)
    images = (ping.raw.astype(numpy.float32), filtered)
    psnr_db = [ensonify.score_image(image, ping.clean)["psnr_db"] for image in images]
    iou = [ensonify.score_mask(image >= 20, ping.mask)["iou"] for image in images]
    print(f"{sigma:5.2f}  {psnr_db[0]:8.2f}  {psnr_db[1]:8.2f}  {iou[0]:7.3f}  {iou[1]:7.3f}")
    strip.append(numpy.vstack([ping.raw, numpy.clip(filtered, 0, 255).astype(numpy.uint8)]))
ensonify.save_png(out / "sweep.png", numpy.hstack(strip))
print(f"raw above, filtered below, in {out / 'sweep.png'}")
