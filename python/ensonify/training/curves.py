"""What a training went through: a row a validation, as CSV and, where gnuplot is installed, as a picture."""

import contextlib
import csv
import pathlib
import subprocess
import typing

from .files import whole_file

Row = typing.Dict[str, typing.Any]


def write_curves(folder: pathlib.Path, rows: typing.Sequence[Row]) -> None:
    """curves.csv and curves.png."""
    with whole_file(folder / "curves.csv") as beside, open(beside, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    script = """set terminal pngcairo size 900,400 font 'sans,10'
set output {out!r}
set multiplot layout 1,2
set grid
set key bottom left
set xlabel 'step'
plot $rows using 1:2 with lines lw 2 title 'training loss'
set key bottom right
set yrange [0:1]
plot $rows using 1:3 with lines lw 2 title 'validation IoU', $rows using 1:4 with lines lw 2 title 'validation F1'
"""
    points = "".join(f"{r['step']} {r['loss']} {r['iou']} {r['f1']}\n" for r in rows)
    # Without gnuplot the numbers stand in curves.csv.
    with contextlib.suppress(OSError, subprocess.CalledProcessError), whole_file(folder / "curves.png") as beside:
        drawing = f"$rows << END\n{points}END\n{script.format(out=str(beside))}"
        subprocess.run(["gnuplot"], input=drawing, text=True, check=True, capture_output=True)
