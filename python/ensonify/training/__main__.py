"""/usr/bin/python3 -m ensonify.training DATA --out DIR ..."""

import sys

import ensonify


def main() -> int:
    """0 done, 1 the work failed, 2 wrong usage, 130 stopped: as the program `ensonify`."""
    try:
        import torch  # noqa: F401
    except ImportError:
        print("error: training needs torch: apt install python3-torch libopenblas0-pthread, and run /usr/bin/python3",
              file=sys.stderr)
        return 1
    from .loop import train
    from .options import parse_options

    try:
        options = parse_options()
        best = train(options)
    except ensonify.ConfigError as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
    except (ensonify.DataError, OSError) as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nstopped; the same command with --resume goes on from the last checkpoint", file=sys.stderr)
        return 130
    print(f"{options.out / 'model.onnx'}: validation IoU {best.iou:.4f}, F1 {best.f1:.4f} at threshold {best.threshold:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
