"""Plots training runs on the same data: losses per epoch, and validation error over seconds of training.

    python3 -m limpid_training.compare RUN RUN ... -o comparison.svg

Each run is labelled with the name of its folder, or with its path if two names are equal. For each pair of runs, also
prints how long one took to reach the final validation error of the other."""

import argparse
import json
import os

from . import features, pictures


def read(run):
    with open(os.path.join(run, "losses.json")) as stream:
        return json.load(stream)


def labels(runs):
    names = [os.path.basename(os.path.normpath(run)) for run in runs]
    return names if len(set(names)) == len(names) else [os.path.normpath(run) for run in runs]


def first_below(values, least):
    """Returns the position, counted from 1, of the first value that is at most `least`; None if there is none."""
    return next((i + 1 for i, value in enumerate(values) if value <= least), None)


def plots(runs):
    """Returns the plots for pictures.write_plots(). `runs` maps names to the content of losses.json."""
    losses = {
        f"{name}, {side}": (range(1, len(run["losses"][side]) + 1), run["losses"][side])
        for name, run in runs.items()
        for side in features.SIDES
        if side in run["losses"]
    }
    validation = {name: (run["times"], run["losses"]["validation"]) for name, run in runs.items()}
    return [("Loss", "epoch", losses), ("relMSE over the noisy picture's", "seconds of training", validation)]


def table(runs):
    """Yields one line per pair of runs: the epoch and time at which one reaches the other's final validation error."""
    for name, run in runs.items():
        for other, reached in runs.items():
            if name == other:
                continue
            goal = reached["losses"]["validation"][-1]
            epoch = first_below(run["losses"]["validation"], goal)
            when = f"epoch {epoch}, {run['times'][epoch - 1]:.0f} s" if epoch else "never"
            end = f"epoch {len(reached['times'])}, {reached['times'][-1]:.0f} s"
            yield f"{name} reaches {other}'s {goal:.4f} ({end}): {when}"


def main():
    parser = argparse.ArgumentParser(prog="limpid_training.compare", description=__doc__.split("\n")[0])
    parser.add_argument("runs", nargs="+", help="output folders of limpid_training.train")
    parser.add_argument("-o", "--output", required=True, help="SVG file to write")
    chosen = parser.parse_args()
    runs = {name: read(run) for name, run in zip(labels(chosen.runs), chosen.runs)}
    pictures.write_plots(chosen.output, plots(runs))
    print("\n".join(table(runs)))


if __name__ == "__main__":
    main()
