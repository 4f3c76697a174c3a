"""Draws runs on the same data beside each other: losses by epoch, and validation by seconds of training:

    python3 -m limpid_training.compare RUN RUN ... -o comparison.svg

Names are those of the runs' folders. Prints how long each run took to what the others reached at their end."""

import argparse
import json
import os

from . import features, pictures


def read(run):
    with open(os.path.join(run, "losses.json")) as stream:
        return json.load(stream)


def first_below(values, least):
    """The number, from 1, of the first of `values` that is at most `least`; None if none is."""
    return next((i + 1 for i, value in enumerate(values) if value <= least), None)


def plots(runs):
    """`runs`: names to what losses.json holds."""
    losses = {
        f"{name}, {side}": (range(1, len(run["losses"][side]) + 1), run["losses"][side])
        for name, run in runs.items()
        for side in features.SIDES
        if side in run["losses"]
    }
    validation = {name: (run["times"], run["losses"]["validation"]) for name, run in runs.items()}
    return [("Loss", "epoch", losses), ("relMSE over the noisy picture's", "seconds of training", validation)]


def table(runs):
    """Lines: for each pair, after how many epochs and seconds one run is as good as the other is at its end."""
    for name, run in runs.items():
        for other, reached in runs.items():
            if name == other:
                continue
            goal = reached["losses"]["validation"][-1]
            epoch = first_below(run["losses"]["validation"], goal)
            when = f"epoch {epoch}, {run['times'][epoch - 1]:.0f} s" if epoch else "never"
            yield (f"{name} reaches {other}'s {goal:.4f} (epoch {len(reached['times'])}, {reached['times'][-1]:.0f} s): {when}")


def main():
    parser = argparse.ArgumentParser(prog="limpid_training.compare", description=__doc__.split("\n")[0])
    parser.add_argument("runs", nargs="+", help="folders of runs")
    parser.add_argument("-o", "--output", required=True, help="SVG file")
    chosen = parser.parse_args()
    runs = {os.path.basename(os.path.normpath(run)): read(run) for run in chosen.runs}
    pictures.write_plots(chosen.output, plots(runs))
    print("\n".join(table(runs)))


if __name__ == "__main__":
    main()
