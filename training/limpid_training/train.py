"""Trains a kernel-predicting network on data that `limpid dataset` rendered.

    python3 -m limpid_training.train DATA -o RUN
    torchrun --nproc_per_node 4 -m limpid_training.train DATA -o RUN     # on four GPUs

The networks for diffuse and specular light are trained separately first, on the mean absolute error of their light in
network space (features.to_network()). Then both are tuned together, on that of the picture. docs/kpcn.md, "Training",
has the details.

RUN receives checkpoint.pt (which --resume continues and --overwrite replaces), losses.json, losses.svg, and
validation.png, which shows one held-out example: noisy, denoised, reference."""

import argparse
import contextlib
import json
import math
import os
import time

import torch

from . import checkpoint, data, features, pictures
from .evaluate import rel_mse
from .network import ANY_FACING, FACING, network_of
from .workers import Workers

PRESETS = {
    "cis565": {
        "loss": "absolute", "warm_up": 0, "logit_decay": 0, "batch": 16, "rate_diffuse": 1e-5, "rate_specular": 1e-4,
        "final_rate": 1.0, "epochs": 10, "tuning_epochs": 0, "inputs": "gradients", "diffuse_input": "linear",
        "facing": ANY_FACING}
}

#: With other values of these, a checkpoint would be of another network or for other pictures.
NETWORK_OPTIONS = ("samples", "hidden", "channels", "width", "inputs", "diffuse_input", "facing", "direct")


def parse(arguments=None):
    parser = argparse.ArgumentParser(prog="limpid_training.train", description=__doc__.split("\n")[0])
    parser.add_argument("data", help="output folder of `limpid dataset`")
    parser.add_argument("-o", "--output", required=True, help="folder for the checkpoint and the plots")
    parser.add_argument("--preset", choices=sorted(PRESETS),
                        help="a named set of defaults for the options below; options that you name override it")
    parser.add_argument("--samples", type=int, default=32, help="samples per pixel of the noisy pictures")
    parser.add_argument("--epochs", type=int, default=30,
                        help="epochs of the first phase, in which the sides are trained separately")
    parser.add_argument("--tuning-epochs", type=int, default=5,
                        help="epochs of the second phase, in which both sides are tuned together")
    parser.add_argument("--patches", type=int, default=16, help="patches per example and epoch")
    parser.add_argument("--patch", type=int, default=128, help="edge length of a patch in pixels")
    parser.add_argument("--vary", action="store_true",
                        help="data augmentation: mirror, turn, recolor and brighten the examples at random")
    parser.add_argument("--batch", type=int, default=16, help="patches per batch and GPU")
    parser.add_argument("--rate-diffuse", type=float, default=1e-4, help="learning rate of the diffuse network")
    parser.add_argument("--rate-specular", type=float, default=1e-4, help="learning rate of the specular network")
    parser.add_argument("--rate-tuning", type=float, default=5e-5, help="learning rate of the second phase")
    parser.add_argument("--logit-decay", type=float, default=1e-5,
                        help="weight of a penalty on the mean squared logit; it keeps kernels from collapsing to "
                        "single pixels, where the softmax has no gradient")
    parser.add_argument("--warm-up", type=float, default=0.04,
                        help="fraction of each phase over which the learning rate rises from 0 to its full value")
    parser.add_argument("--final-rate", type=float, default=0.05,
                        help="learning rate at the end of a phase, as a fraction of its full value; it falls along "
                        "half a cosine")
    parser.add_argument("--loss", choices=("logarithmic", "absolute"), default="logarithmic",
                        help="mean absolute error of log(x + 0.1), or as in the paper, of x (x: diffuse light or the "
                        "picture; specular light is logarithmic already)")
    parser.add_argument("--hidden", type=int, default=8, help="number of hidden convolutions")
    parser.add_argument("--channels", type=int, default=100, help="channels of the hidden convolutions")
    parser.add_argument("--width", type=int, default=21, help="edge length of the kernels in pixels; odd")
    parser.add_argument("--inputs", choices=sorted(features.INPUTS), default="all",
                        help="input channels to use: all 34, or only the gradients of albedo, normal and depth")
    parser.add_argument("--diffuse-input", choices=features.DIFFUSE_INPUTS, default="logarithmic",
                        help="what the network for diffuse light sees: log(1 + light), or as in the paper the light")
    parser.add_argument("--facing", type=float, default=FACING,
                        help="minimum cosine between a pixel's normal and those of the pixels in its kernel; "
                        "-2: no condition")
    parser.add_argument("--direct", action="store_true",
                        help="predict colours instead of kernels, to compare the two; such a network cannot be "
                        "exported")
    parser.add_argument("--validation", type=float, default=0.1,
                        help="fraction of the examples that is held out for validation")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--time-limit", type=float, default=0,
                        help="do not begin another epoch after this many seconds; 0: no limit")
    existing = parser.add_mutually_exclusive_group()
    existing.add_argument("--resume", action="store_true", help="continue from the checkpoint in the output folder")
    existing.add_argument("--overwrite", action="store_true",
                          help="begin anew where the output folder has a checkpoint, and replace it")
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    chosen, _ = parser.parse_known_args(arguments)
    if chosen.preset:
        parser.set_defaults(**PRESETS[chosen.preset])
    return parser.parse_args(arguments)


def split(count, held_out):
    """Returns the indices of the training examples and of the held-out ones. Held-out examples are evenly spread,
    because scenes of one kind are stored next to each other. Both even and odd ones are held out, because every second
    example has its rays through the pixels' centres."""
    validated = [i for i in range(count) if (i + 1) * held_out // count > i * held_out // count]
    if len({i % 2 for i in validated}) == 1:
        validated = [i - k % 2 for k, i in enumerate(validated)]
    return sorted(set(range(count)) - set(validated)), validated


class Trainer:
    def __init__(self, options):
        self.options = options
        if options.direct and options.loss != "absolute":
            checkpoint.end("--direct needs --loss absolute: predicted colours can be negative and have no logarithm",
                           checkpoint.USAGE)
        # Before the workers are connected: those that end without close() may leave others waiting.
        self.saved = self.load() if options.resume else None
        if not (options.resume or options.overwrite):
            checkpoint.refuse_to_replace(options.output)
        self.workers = Workers(options.device)
        torch.manual_seed(options.seed)
        self.net = network_of(vars(options)).to(self.workers.device)
        if self.half:
            self.net = self.net.to(memory_format=torch.channels_last)
            torch.backends.cudnn.benchmark = True
        self.predictors = {side: self.workers.shared(getattr(self.net, side)) for side in features.SIDES}
        self.examples = data.Dataset(options.data, options.samples, self.workers.device)
        held_out = max(1, round(options.validation * len(self.examples)))
        if held_out >= len(self.examples):
            checkpoint.end(f"{options.data}: {len(self.examples)} examples are too few", checkpoint.USAGE)
        self.learnt, self.validated = split(len(self.examples), held_out)
        if len(self.learnt) < self.workers.count:
            checkpoint.end(f"{options.data}: {self.workers.count} processes cannot share {len(self.learnt)} examples",
                           checkpoint.USAGE)
        self.rates = {"diffuse": options.rate_diffuse, "specular": options.rate_specular, "both": options.rate_tuning}
        self.optimizers = {
            name: torch.optim.Adam((self.net if name == "both" else getattr(self.net, name)).parameters(), lr=rate)
            for name, rate in self.rates.items()
        }
        self.scaler = torch.cuda.amp.GradScaler(enabled=self.half)
        self.batches_done = dict.fromkeys(self.rates, 0)
        batches = len(self.learnt) // self.workers.count * options.patches / options.batch  # per epoch
        lengths = {"both": options.tuning_epochs}
        self.warm_up = {name: max(options.warm_up * lengths.get(name, options.epochs) * batches, 1.0)
                        for name in self.rates}
        self.epoch, self.seconds, self.losses, self.times = 0, 0.0, {}, []

    @property
    def half(self):
        return self.workers.device.type == "cuda"

    @property
    def epochs(self):
        return self.options.epochs + self.options.tuning_epochs

    def loss(self, side, batch):
        """Returns the loss, which is reported, and the penalty on logits, which is added for the gradient only.
        `side`: "diffuse", "specular" or "both"."""
        with torch.autocast("cuda", dtype=torch.float16) if self.half else contextlib.nullcontext():
            sides = features.SIDES if side == "both" else (side,)
            parts = {name: self.net.side_and_logits(name, batch, self.predictors[name]) for name in sides}
            if side == "both":
                result = features.recombined({name: part[0] for name, part in parts.items()}, batch["albedo"])
                target = batch["target"]
            else:
                result, target = parts[side][0], batch[side + ".target"]
            # Logarithms make errors relative; otherwise a few bright patches would dominate. Specular light is a
            # logarithm already.
            if self.options.loss == "logarithmic" and side != "specular":
                result, target = (result.float() + 0.1).log(), (target.clamp(min=0.0) + 0.1).log()
            decay = sum(logits.square().mean() for _, logits in parts.values())
            return (result - target).abs().mean(), self.options.logit_decay * decay

    def step(self, side, batch):
        optimizer = self.optimizers[side]
        self.batches_done[side] += 1
        for group in optimizer.param_groups:
            group["lr"] = self.rate_now[side] * min(self.batches_done[side] / self.warm_up[side], 1.0) ** 2
        optimizer.zero_grad(set_to_none=True)
        loss, decay = self.loss(side, batch)
        self.scaler.scale(loss + decay).backward()
        self.scaler.step(optimizer)
        self.scaler.update()
        return loss.detach()

    def set_rates(self):
        """Sets the learning rates of this epoch. They fall along half a cosine over each phase. step() applies the
        warm-up on top of that."""
        self.rate_now = {}
        first, second = self.options.epochs, self.options.tuning_epochs
        phases = ((0, first, features.SIDES), (first, second, ("both",)))
        for begin, length, names in phases:
            done = min(max(self.epoch - begin, 0) / max(length, 1), 1.0)
            share = self.options.final_rate + (1 - self.options.final_rate) * 0.5 * (1 + math.cos(math.pi * done))
            for name in names:
                self.rate_now[name] = self.rates[name] * share

    def batches(self):
        """Yields this worker's batches of one epoch. Each batch mixes patches of several examples. The batches depend
        only on the seed, the epoch, and the number of workers."""
        generator = torch.Generator().manual_seed(self.options.seed * 1000003 + self.epoch)
        order = torch.randperm(len(self.learnt), generator=generator).tolist()
        share = order[self.workers.number :: self.workers.count]
        share = share[: len(order) // self.workers.count]  # equal: workers wait for each other in every batch
        generator.manual_seed(generator.initial_seed() + 7919 * self.workers.number)
        size = self.options.batch
        for begin in range(0, len(share), size):
            pool = []
            for index in share[begin : begin + size]:
                frame, patch = self.examples[self.learnt[index]], self.options.patch
                if self.options.vary:
                    frame = data.varied(frame, generator)
                    patch = min(patch, *frame["depth"].shape[2:])  # turned or not, all have the same shape
                pool += data.patches(self.net.prepare(frame), frame, patch, self.options.patches, generator)
            pool = data.shuffled(pool, torch.randperm(len(pool), generator=generator))
            for i in range(0, len(pool), size):
                yield data.batch_of(pool[i : i + size])

    def train_epoch(self):
        sides = features.SIDES if self.epoch < self.options.epochs else ("both",)
        sums, counts, batches = dict.fromkeys(sides, 0.0), dict.fromkeys(sides, 0), 0
        self.set_rates()
        for batch in self.batches():
            for side in sides:
                loss = self.step(side, batch)
                finite = torch.isfinite(loss)  # half precision overflows at times; the scaler then skips the step
                sums[side] += torch.where(finite, loss, torch.zeros_like(loss))
                counts[side] += finite
            batches += 1
        for side in sides:
            if int(counts[side]) < 0.9 * batches:
                raise SystemExit(f"epoch {self.epoch + 1}: {batches - int(counts[side])} of {batches} losses of "
                                 f"'{side}' are no finite numbers; lower its rate, or use a longer --warm-up")
            self.losses.setdefault(side, []).append(float(sums[side]) / max(int(counts[side]), 1))
        # Without the scaler, a single loss spoils them. The checkpoint of the epoch before is worth more.
        if not all(bool(torch.isfinite(weight).all()) for weight in self.net.parameters()):
            raise SystemExit(f"epoch {self.epoch + 1}: weights are no finite numbers any more; lower the rate, or use "
                             "a longer --warm-up")

    @torch.no_grad()
    def validate(self):
        """Appends the validation error: the relMSE of the denoised picture divided by that of the noisy one, averaged
        over the held-out examples. Keeps the last example for validation.png."""
        total = 0.0
        for index in self.validated:
            frame = self.examples[index]
            prepared = self.net.prepare(frame)
            noisy, target, result = frame["diffuse"] + frame["specular"], prepared["target"], self.net(prepared)
            total += rel_mse(result, target) / max(rel_mse(noisy, target), 1e-12)
        self.losses.setdefault("validation", []).append(total / len(self.validated))
        self.shown = [noisy, result, target]

    def scenes(self, indices):
        return [self.examples.examples[i][2] for i in indices]

    def save(self):
        folder = self.options.output
        state = {
            "net": self.net.state_dict(),
            "optimizers": {name: optimizer.state_dict() for name, optimizer in self.optimizers.items()},
            "scaler": self.scaler.state_dict(),
            "batches_done": self.batches_done,
            "workers": self.workers.count,
            "epoch": self.epoch,
            "seconds": self.seconds,
            "losses": self.losses,
            "times": self.times,
            "options": vars(self.options),
            "dataset": self.examples.manifest["dataset"],
            "validated": self.scenes(self.validated),
            "learnt": self.scenes(self.learnt),
        }
        checkpoint.replace(checkpoint.path_in(folder), lambda stream: torch.save(state, stream))
        losses = json.dumps({"seconds": self.seconds, "losses": self.losses, "times": self.times}, indent=1)
        checkpoint.replace(os.path.join(folder, "losses.json"), lambda stream: stream.write(losses.encode()))
        pictures.write_curves(os.path.join(folder, "losses.svg"), self.losses, phases=("both",))
        row = torch.cat([pictures.shown(light[0].cpu()) for light in self.shown], dim=2)
        pictures.write_png(os.path.join(folder, "validation.png"), row)

    def load(self):
        """Returns the checkpoint, if it is of this network."""
        state = checkpoint.load(self.options.output)
        for name in NETWORK_OPTIONS:
            now = getattr(self.options, name)
            before = state["options"].get(name, now)
            if before != now:
                checkpoint.end(f"{checkpoint.path_in(self.options.output)}: was trained with "
                               f"--{name.replace('_', '-')} {before}, not {now}", checkpoint.USAGE)
        return state

    def resume(self):
        state, self.saved = self.saved, None
        if state.get("validated", self.scenes(self.validated)) != self.scenes(self.validated):
            checkpoint.end(f"{checkpoint.path_in(self.options.output)}: other examples were held out; go on with the "
                           "same data and --validation", checkpoint.USAGE)
        self.net.load_state_dict(state["net"])
        for name, optimizer in self.optimizers.items():
            optimizer.load_state_dict(state["optimizers"][name])
        if state["scaler"]:  # empty if a CPU has saved it
            self.scaler.load_state_dict(state["scaler"])
        # Another number of workers makes another number of batches of an epoch.
        share = state.get("workers", 1) / self.workers.count
        self.batches_done = {name: done * share for name, done in state["batches_done"].items()}
        self.epoch, self.seconds, self.losses = state["epoch"], state["seconds"], state["losses"]
        self.times = state["times"]

    def run(self):
        if self.options.resume:
            self.resume()
        os.makedirs(self.options.output, exist_ok=True)
        began, before, judging = time.monotonic(), self.seconds, 0.0
        while self.epoch < self.epochs:
            late = bool(self.options.time_limit) and time.monotonic() - began > self.options.time_limit
            if self.workers.agreed(late):
                break
            self.train_epoch()
            self.epoch += 1
            self.seconds = before + time.monotonic() - began - judging
            self.times.append(self.seconds)
            if self.workers.number > 0:
                continue
            started = time.monotonic()
            self.validate()
            self.save()
            judging += time.monotonic() - started
            last = ", ".join(f"{name} {curve[-1]:.5f}" for name, curve in self.losses.items())
            print(f"epoch {self.epoch} of {self.epochs}, {self.seconds:.0f} s: {last}", flush=True)
        self.close()
        return self.losses

    def close(self):
        """Nothing more can be learnt afterwards."""
        self.predictors = {}
        self.workers.close()


if __name__ == "__main__":
    Trainer(parse()).run()
