"""Trains the network of `nano` or `film` on clips that `limpid dataset --sequence` rendered.

    python3 -m limpid_training.nano.train CLIPS -o RUN --seconds 600
    torchrun --nproc_per_node 4 -m limpid_training.nano.train CLIPS -o RUN --seconds 600     # on four GPUs

docs/nano.md, "Training", has the details. RUN receives checkpoint.pt (which --resume continues and --overwrite
replaces), losses.json and losses.svg, and with --validation validation.png, which shows a frame: accumulated light,
SVGF's picture, the network's, and the reference."""

import argparse
import copy
import json
import math
import os
import time

import torch
from torch import nn

from .. import checkpoint, pictures
from ..workers import Workers
from . import clips, evaluate, loss, network, weights

#: Weight of the loss of the filter's own picture, beside that of the mixed one. Where SVGF's share is large, the mixed
#: picture says little about the filter, which could then never become the better one.
OWN_WEIGHT = 0.3

#: Weight of the loss of the error's change from frame to frame, where both frames are in the clips. It counts errors
#: that flicker more than those that stay: of two pictures with the same error, the calmer one is better.
CHANGE_WEIGHT = 0.15

#: Steps in which the learning rate rises to its full value.
WARM_UP = 100

#: The gradient's largest norm.
LARGEST_GRADIENT = 1.0

#: The means of the weights cover about 1,000 steps; at the beginning fewer, so that they forget the first weights.
MEAN_DECAY = 0.999

#: Several workers agree on the time, on which the learning rate and the end depend, once in so many steps.
AGREE_EVERY = 25


def numbers(text):
    return tuple(int(number) for number in text.split(","))


def text_of(numbers):
    return ",".join(map(str, numbers))


def parse(arguments=None):
    parser = argparse.ArgumentParser(prog="limpid_training.nano.train", description=__doc__.split("\n")[0])
    parser.add_argument("clips", nargs="+", help="output folders of `limpid dataset --sequence`")
    parser.add_argument("-o", "--output", required=True, help="folder for the checkpoint and the plots")
    length = parser.add_mutually_exclusive_group(required=True)
    length.add_argument("--seconds", type=float, help="length of the training; over it the learning rate falls")
    length.add_argument("--steps", type=int, help="the same, counted in batches")
    parser.add_argument("--validation", metavar="CLIPS", help="other clips, to measure errors on")
    parser.add_argument("--batch", type=int, default=16,
                        help="crops per batch and GPU; half as many pairs if the clips have consecutive frames")
    parser.add_argument("--crop", type=int, default=192,
                        help="edge length of a crop in pixels; smaller if frames are")
    parser.add_argument("--rate", type=float, default=2e-3, help="the largest learning rate")
    parser.add_argument("--last-rate", type=float, default=2e-4,
                        help="the learning rate at the end; it falls along half a cosine")
    parser.add_argument("--relative", type=float, default=0.0,
                        help="weight of relative differences of light, as in relMSE, beside those of sRGB; 0 to 1")
    parser.add_argument("--network", choices=list(network.SHAPES), default="nano", help="whose shape the network has")
    for name, about in (("widths", "channels"), ("depths", "convolutions of 3x3 pixels on the way down"),
                        ("kernels", "width of the kernels, pixels; odd")):
        parser.add_argument("--" + name, type=numbers,
                            help=about + ", level by level, if not those of --network; Limpid computes only those")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--start", metavar="FILE",
                        help="begin with the weights and the optimiser's state of a run or a checkpoint, or with a "
                        "file of weights")
    parser.add_argument("--report", type=float, default=20, help="seconds between reports")
    parser.add_argument("--save", type=float, default=60, help="seconds between checkpoints, with validation")
    parser.add_argument("--time-limit", type=float, default=0,
                        help="stop after about this many seconds, for --resume to go on; 0: no limit")
    existing = parser.add_mutually_exclusive_group()
    existing.add_argument("--resume", action="store_true", help="continue from the checkpoint in the output folder")
    existing.add_argument("--overwrite", action="store_true",
                          help="begin anew where the output folder has a checkpoint, and replace it")
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    chosen = parser.parse_args(arguments)
    for name, value in network.SHAPES[chosen.network]._asdict().items():
        if getattr(chosen, name) is None:
            setattr(chosen, name, value)
    if chosen.resume and chosen.start:
        parser.error("--start is not allowed with --resume, which begins with the weights in the output folder")
    if not len(chosen.widths) == len(chosen.depths) == len(chosen.kernels):
        parser.error("--widths, --depths and --kernels are of different numbers of levels")
    if any(width % 2 == 0 for width in chosen.kernels):
        parser.error("--kernels: a kernel of even width has no centre")
    return chosen


class Trainer:
    def __init__(self, options):
        self.options = options
        self.shape = network.Shape(options.widths, options.depths, options.kernels)
        # Before the workers are connected: those that end without close() may leave others waiting.
        saved = self.load()
        self.workers = Workers(options.device)
        if self.workers.device.type == "cuda":
            torch.backends.cudnn.benchmark = True
            torch.backends.cuda.matmul.allow_tf32 = torch.backends.cudnn.allow_tf32 = True
        torch.manual_seed(options.seed)
        self.net = network.Net(self.shape).to(self.workers.device)
        self.optimizer = torch.optim.AdamW(self.net.parameters(), lr=options.rate, betas=(0.9, 0.99),
                                           weight_decay=1e-4)
        self.step, self.first, self.reports, self.validations = 0, 0, [], []
        #: Of training, as the workers have last agreed. elapsed() is exact, but differs among them.
        self.seconds = 0.0
        self.average = copy.deepcopy(self.net)  # has the means of the weights over the last steps
        if saved:
            self.restore(saved)
        self.predictor = self.workers.shared(self.net)
        try:
            self.use([clips.load(folder, self.workers.device, self.workers.number, self.workers.count)
                      for folder in options.clips])
            self.judged = []
            if options.validation and self.workers.number == 0:
                self.judged = clips.load(options.validation, self.workers.device)
            self.datasets = [clips.manifest_of(folder)["dataset"] for folder in options.clips]
        except (OSError, ValueError) as fault:
            checkpoint.end(str(fault), checkpoint.UNREADABLE)
        self.clear_sums()

    def use(self, folders):
        """Learns from these lists of frames, one of each folder. Raises ValueError if only some folders have pairs."""
        self.frames = [frame for frames in folders for frame in frames]
        self.edge = min(self.options.crop, clips.smallest_edge(self.frames))
        pairs = [clips.pairs_of(frames) for frames in folders]
        self.paired = any(pairs)
        if self.paired and not all(pairs):
            folder = self.options.clips[pairs.index([])]
            raise ValueError(f"{folder}: has no consecutive frames, but other clips have; train on either kind")
        #: What crops are cut from: pairs of frames, or single ones where no two follow each other.
        self.groups = [group for of_folder in pairs for group in of_folder] or [(frame,) for frame in self.frames]

    def load(self):
        """Returns the checkpoint to begin with, if it is of this network; None if the weights are new."""
        options = self.options
        if not (options.resume or options.overwrite):
            checkpoint.refuse_to_replace(options.output)
        if not (options.resume or options.start):
            return None
        path = checkpoint.path_in(options.output) if options.resume else options.start
        state = checkpoint.load(options.output) if options.resume else weights.read(path)
        shape = network.shape_of(state["net"])
        for name in network.Shape._fields:
            before, now = getattr(shape, name), getattr(self.shape, name)
            if before != now:
                checkpoint.end(f"{path}: was trained with --{name} {text_of(before)}, not {text_of(now)}",
                               checkpoint.USAGE)
        return state

    def restore(self, state):
        self.net.load_state_dict(state["net"])
        self.average.load_state_dict(weights.of_checkpoint(state))
        if "opt" in state:
            self.optimizer.load_state_dict(state["opt"])
        # A new training warms up, also if it begins with the weights of another.
        self.first = self.step = state.get("step", 0)
        if self.options.resume:
            self.first = state.get("first", self.step)
            self.seconds = state.get("seconds", 0.0)
            self.reports, self.validations = state.get("reports", []), state.get("validations", [])

    def generator(self):
        """Random numbers that depend only on the seed, the step and the worker: so a training that is resumed goes on
        as one that was not stopped."""
        return torch.Generator().manual_seed((self.options.seed * 1000003 + self.step) * 1024 + self.workers.number)

    def progress(self):
        """The part of the training that is done, from 0 to 1."""
        if self.options.steps is not None:
            return min((self.step - self.first) / max(self.options.steps, 1), 1)
        return min(self.seconds / self.options.seconds, 1) if self.options.seconds > 0 else 1

    def rate(self):
        options = self.options
        share = 0.5 + 0.5 * math.cos(math.pi * self.progress())
        warmth = min(1, (self.step - self.first + 1) / WARM_UP)
        return (options.last_rate + (options.rate - options.last_rate) * share) * warmth

    def batch(self):
        generator = self.generator()
        count = max(self.options.batch // (2 if self.paired else 1), 1)
        chosen = clips.crops(self.groups, count, self.edge, generator)
        return clips.Frame(clips.varied(chosen, generator))

    def elapsed(self):
        """Seconds of training by this worker's clock."""
        return self.before + time.monotonic() - self.began

    def loss(self, frame):
        """Returns the loss of a batch, and adds what report() tells of it."""
        filtered = network.denoise(self.net, frame, self.predictor)
        picture, own = frame.compose(filtered.light), frame.compose(filtered.own)
        judge = loss.Judge(frame, self.options.relative)
        result = judge.loss(picture) + OWN_WEIGHT * judge.loss(own)
        if self.paired:
            result = result + CHANGE_WEIGHT * judge.change(picture)
        with torch.no_grad():
            self.sums += torch.stack([judge.error(picture), judge.error(frame.svgf), judge.error(own),
                                      filtered.share.mean(), result])
        return result

    def learn(self):
        """One step."""
        for group in self.optimizer.param_groups:
            group["lr"] = self.rate()
        self.optimizer.zero_grad(set_to_none=True)
        self.loss(self.batch()).backward()
        nn.utils.clip_grad_norm_(self.net.parameters(), LARGEST_GRADIENT)
        self.optimizer.step()
        decay = min(MEAN_DECAY, (self.step + 1) / (self.step + 10))
        with torch.no_grad():
            for mean, weight in zip(self.average.parameters(), self.net.parameters()):
                mean.mul_(decay).add_(weight, alpha=1 - decay)
        self.step += 1
        self.counted += 1

    def clear_sums(self):
        self.sums, self.counted = torch.zeros(5, device=self.workers.device), 0

    def report(self):
        if not self.counted:
            return
        picture, svgf, own, share, mean_loss = (self.sums / self.counted).tolist()
        least = max(svgf, 1e-9)  # the estimate of an error that is about 0 can be negative
        seconds = self.elapsed()
        self.reports.append({"step": self.step, "seconds": seconds, "training": picture / least,
                             "own": own / least, "share": share, "loss": mean_loss, "rate": self.rate()})
        print(f"step {self.step}, {seconds:.0f} s: error over SVGF's {picture / least:.4f}, of the filter alone "
              f"{own / least:.4f}, its share {share:.2f}, loss {mean_loss:.3e}, rate {self.rate():.2e}", flush=True)
        self.clear_sums()

    def validate(self):
        if not self.judged:
            return
        results = evaluate.evaluate(self.average, self.judged)
        ratios = evaluate.ratios(results)
        self.validations.append({"step": self.step, "seconds": self.elapsed(), "ratios": ratios})
        print("    network / SVGF (difference): " + evaluate.line(results), flush=True)
        print("    clips' geometric mean over SVGF's: " + "  ".join(f"{k} {v:.4f}" for k, v in ratios.items()),
              flush=True)

    def save(self):
        # The checkpoint before is worth more than one without numbers.
        if not all(bool(torch.isfinite(weight).all()) for weight in self.net.parameters()):
            raise SystemExit(f"step {self.step}: weights are no finite numbers any more; lower the rate")
        folder = self.options.output
        state = {
            "net": self.net.state_dict(),
            "opt": self.optimizer.state_dict(),
            "ema": [weight.detach() for weight in self.average.parameters()],
            "step": self.step,
            "first": self.first,
            "seconds": self.elapsed(),
            "reports": self.reports,
            "validations": self.validations,
            "options": vars(self.options),
            "datasets": self.datasets,
        }
        checkpoint.replace(checkpoint.path_in(folder), lambda stream: torch.save(state, stream))
        losses = json.dumps({"reports": self.reports, "validations": self.validations}, indent=1)
        checkpoint.replace(os.path.join(folder, "losses.json"), lambda stream: stream.write(losses.encode()))
        self.plot(os.path.join(folder, "losses.svg"))
        if self.judged:
            shown = [frame for frame in self.judged if frame.clip == self.judged[0].clip][-1]
            pictures.write_png(os.path.join(folder, "validation.png"), evaluate.row(self.average, shown))

    def plot(self, path):
        def curve(entries, value):
            return [entry["step"] for entry in entries], [value(entry) for entry in entries]

        curves = {"picture": curve(self.reports, lambda entry: entry["training"]),
                  "the filter alone": curve(self.reports, lambda entry: entry["own"])}
        for error in ("square", "relative") if self.validations else ():
            curves["validation, " + error] = curve(self.validations, lambda entry: entry["ratios"][error])
        pictures.write_plots(path, [("Errors over SVGF's", "step", curves)], width=720)

    def run(self):
        options, first_worker = self.options, self.workers.number == 0
        if first_worker:
            os.makedirs(options.output, exist_ok=True)
            weights_count = sum(weight.numel() for weight in self.net.parameters())
            name = network.name_of(self.shape) or "a network that Limpid does not compute"
            print(f"{name}: {weights_count} weights, {self.net.multiplications():.0f} multiplications per pixel; "
                  f"{len(self.frames)} frames, {len(self.groups) if self.paired else 0} pairs, "
                  f"{len(self.judged)} frames to validate", flush=True)
        self.before, self.began = self.seconds, time.monotonic()
        reported = saved = self.began
        while self.progress() < 1:
            self.learn()
            if self.workers.count == 1 or self.step % AGREE_EVERY == 0:
                self.seconds = self.workers.told(self.elapsed())
                if options.time_limit and self.seconds - self.before > options.time_limit:
                    break
            now = time.monotonic()
            if first_worker and now - reported > options.report:
                self.report()
                reported = now
            if first_worker and now - saved > options.save:
                self.save_and_validate()
                saved = now
        if first_worker:
            self.report()
            self.save_and_validate()
        self.close()

    def save_and_validate(self):
        """Saves before and after: nothing is lost where validating fails, or a borrowed machine ends meanwhile."""
        self.save()
        if self.judged:
            self.validate()
            self.save()

    def close(self):
        """Nothing more can be learnt afterwards."""
        self.predictor = None
        self.workers.close()


if __name__ == "__main__":
    Trainer(parse()).run()
