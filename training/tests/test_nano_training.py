import contextlib
import io
import json
import os
import tempfile
import unittest
from unittest import mock
from xml.etree import ElementTree

import torch

from limpid_training import checkpoint, tensor_file
from limpid_training.nano import clips, compare, evaluate, export, loss, network, train, weights

from . import nano_clips, together

SMALL = ("--widths", "8,16", "--depths", "0,1", "--kernels", "3,3")


def equal(a, b):
    return all(torch.equal(x, y) for x, y in zip(a.parameters(), b.parameters()))


class TrainingTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.data = nano_clips.make_clips(os.path.join(self.folder, "clips"))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def options(self, run, *more, shape=SMALL):
        common = "--batch 2 --crop 32 --device cpu --report 1000 --save 1000"
        return [self.data, "-o", self.path(run), *common.split(), *shape, *more]

    def trainer(self, run, *more, **how):
        return train.Trainer(train.parse(self.options(run, *more, **how)))

    def train(self, run, *more, **how):
        trainer = self.trainer(run, *more, **how)
        with contextlib.redirect_stdout(io.StringIO()):
            trainer.run()
        return trainer

    def ends(self, code, text, call, *arguments, **how):
        """Checks the exit code and the message of a program that a call ends."""
        told = io.StringIO()
        with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(told):
            call(*arguments, **how)
        self.assertEqual(ended.exception.code, code)
        self.assertIn(text, told.getvalue())

    def test_some_steps_lower_the_loss_and_the_error(self):
        trainer = self.trainer("run", "--steps", "60", "--rate", "1e-2")
        frame = clips.Frame(nano_clips.make_batch(seed=11))
        judge = loss.Judge(frame)

        @torch.no_grad()
        def judged():
            picture = frame.compose(network.denoise(trainer.net, frame).light)
            return judge.loss(picture).item(), judge.error(picture).item()

        before = judged()
        with contextlib.redirect_stdout(io.StringIO()):
            trainer.run()
        after = judged()
        self.assertLess(after[0], 0.6 * before[0])
        self.assertLess(after[1], 0.5 * before[1])
        self.assertLess(after[1], 0.5 * judge.error(frame.svgf).item(), "SVGF's picture is too dark")

    def trainer_of(self, *folders):
        return train.Trainer(train.parse([*folders, *self.options("run", "--steps", "2")[1:]]))

    def test_pairs_of_frames_and_several_folders(self):
        folders = [nano_clips.make_clips(self.path(str(first)), numbers=(first, first + 1)) for first in (4, 5)]
        trainer = self.trainer_of(*folders)
        self.assertEqual(len(trainer.frames), 8)
        self.assertEqual([(before.clip, before.number, after.clip, after.number) for before, after in trainer.groups],
                         [(clip, n, clip, n + 1) for n in (4, 5) for clip in ("000000", "000001")])
        frame = trainer.batch()
        self.assertEqual(frame.depth.shape, (2, 1, 32, 32), "one pair is a batch of two")
        with mock.patch.object(loss.Judge, "change", lambda judge, picture: 100 * picture.mean()):
            changed = trainer.loss(frame).item()
        self.assertGreater(changed, trainer.loss(frame).item() + 1)

    def test_frames_of_different_folders_are_no_pairs(self):
        folders = [nano_clips.make_clips(self.path(str(n)), files=1, numbers=(n,)) for n in (1, 2)]
        trainer = self.trainer_of(*folders)
        self.assertFalse(trainer.paired)
        self.assertEqual([[frame.number for frame in group] for group in trainer.groups], [[1], [2]])

    def test_folders_with_and_without_pairs_are_refused(self):
        paired = nano_clips.make_clips(self.path("paired"), numbers=(4, 5))
        text = self.data + ": has no consecutive frames"
        self.ends(3, text, self.trainer_of, paired, self.data)
        self.ends(3, text, self.trainer_of, self.data, paired)

    def test_says_how_many_pairs_there_are(self):
        told = io.StringIO()
        paired = nano_clips.make_clips(self.path("paired"), numbers=(4, 5, 6))
        with contextlib.redirect_stdout(told):
            self.trainer_of(paired).run()
        self.assertIn("6 frames, 4 pairs, 0 frames to validate", told.getvalue())

    def test_leaves_what_it_learnt(self):
        other = nano_clips.make_clips(self.path("other"), files=1, rows=20, columns=24)
        trainer = self.train("run", "--steps", "6", "--save", "0", "--report", "0", "--validation", other)
        for name in "checkpoint.pt", "losses.json", "losses.svg", "validation.png":
            self.assertGreater(os.path.getsize(self.path("run", name)), 100, name)
        self.assertEqual(len(os.listdir(self.path("run"))), 4)
        plot = ElementTree.parse(self.path("run", "losses.svg")).getroot()
        self.assertIn("validation, square", "".join(plot.itertext()))
        with open(self.path("run", "losses.json")) as stream:
            losses = json.load(stream)
        self.assertEqual([report["step"] for report in losses["reports"]], [1, 2, 3, 4, 5, 6])
        self.assertEqual(losses["validations"][-1]["ratios"].keys(), evaluate.ERRORS.keys())
        # What counts is the mean of the weights over the steps.
        self.assertTrue(equal(weights.network_in(self.path("run")), trainer.average))
        self.assertFalse(equal(trainer.average, trainer.net))

        told = io.StringIO()
        arguments = ["evaluate", self.path("run"), other, "--device", "cpu", "--pictures", self.path("pictures")]
        with mock.patch("sys.argv", arguments), contextlib.redirect_stdout(told):
            evaluate.main()
        self.assertIn("clip 000000: square", told.getvalue())
        self.assertEqual(os.listdir(self.path("pictures")), ["000000.png"])

    def test_goes_on_where_it_was_stopped(self):
        whole = self.train("whole", "--steps", "6")
        parts = self.train("parts", "--steps", "6", "--time-limit", "1e-9")
        self.assertEqual(parts.step, 1)
        parts = self.train("parts", "--steps", "6", "--resume")
        self.assertEqual(parts.step, 6)
        self.assertTrue(equal(whole.net, parts.net))
        self.assertTrue(equal(whole.average, parts.average))
        states = [checkpoint.load(self.path(run))["opt"]["state"] for run in ("whole", "parts")]
        for a, b in zip(*(state.values() for state in states)):
            self.assertTrue(torch.equal(a["exp_avg_sq"], b["exp_avg_sq"]))
        # What is done is not done again.
        self.assertTrue(equal(self.train("parts", "--steps", "6", "--resume").net, whole.net))

    def test_seconds_end_it(self):
        clock = mock.Mock(side_effect=range(100000))
        with mock.patch.object(train.time, "monotonic", clock):
            trainer = self.train("run", "--seconds", "12")
            self.assertLess(trainer.step, 20)
            self.assertEqual(trainer.progress(), 1)
            self.assertAlmostEqual(trainer.rate(), 2e-4 * min(1, (trainer.step + 1) / train.WARM_UP))
            stopped = self.train("run", "--seconds", "40", "--overwrite", "--time-limit", "5")
            self.assertLess(stopped.progress(), 1)
            resumed = self.train("run", "--seconds", "40", "--resume")
        self.assertGreater(resumed.step, stopped.step)
        self.assertGreater(resumed.before, 5)

    def test_the_rate_rises_and_falls(self):
        trainer = self.trainer("run", "--steps", "1000", "--rate", "1", "--last-rate", "0.5")
        for step, rate in (0, 0.01), (499, 0.75), (1000, 0.5):
            trainer.step = step
            self.assertAlmostEqual(trainer.rate(), rate, places=2)

    def test_batches_depend_on_the_seed_the_step_and_the_worker(self):
        trainer = self.trainer("run", "--steps", "2")
        first = trainer.batch().svgf
        self.assertTrue(torch.equal(trainer.batch().svgf, first))
        trainer.workers.number = 1
        self.assertFalse(torch.equal(trainer.batch().svgf, first))
        trainer.workers.number, trainer.step = 0, 1
        self.assertFalse(torch.equal(trainer.batch().svgf, first))
        trainer.step, trainer.options.seed = 0, 1
        self.assertFalse(torch.equal(trainer.batch().svgf, first))

    def test_means_cover_more_and_more_steps(self):
        trainer = self.trainer("run", "--steps", "2")
        for step, decay in (0, 0.1), (90, 0.91), (100000, 0.999):
            trainer.step = step
            before = [mean.clone() for mean in trainer.average.parameters()]
            trainer.learn()
            for old, mean, weight in zip(before, trainer.average.parameters(), trainer.net.parameters()):
                self.assertTrue(torch.allclose(mean, decay * old + (1 - decay) * weight, atol=1e-6))

    def test_a_checkpoint_of_the_prototype_goes_on(self):
        before = self.train("run", "--steps", "3")
        state = checkpoint.load(self.path("run"))
        torch.save({key: state[key] for key in ("net", "opt", "ema", "step")}, self.path("run", "checkpoint.pt"))
        trainer = self.trainer("run", "--steps", "2", "--resume")
        self.assertTrue(equal(trainer.net, before.net) and equal(trainer.average, before.average))
        self.assertEqual((trainer.step, trainer.progress()), (3, 0))
        with contextlib.redirect_stdout(io.StringIO()):
            trainer.run()
        self.assertEqual(checkpoint.load(self.path("run"))["step"], 5)

    def test_begins_with_other_weights(self):
        before = self.train("run", "--steps", "3")
        trainer = self.trainer("more", "--steps", "2", "--start", self.path("run"))
        self.assertTrue(equal(trainer.net, before.net) and equal(trainer.average, before.average))
        self.assertEqual((trainer.progress(), trainer.reports), (0, []))
        trainer = self.trainer("shipped", "--steps", "2", "--start", compare.SHIPPED["nano"], shape=())
        self.assertTrue(equal(trainer.net, weights.network_in(compare.SHIPPED["nano"])))
        film = ("--steps", "2", "--start", compare.SHIPPED["film"])
        trainer = self.trainer("film", *film, "--network", "film", shape=())
        self.assertEqual(trainer.net.shape, network.SHAPES["film"])
        self.assertTrue(equal(trainer.net, weights.network_in(compare.SHIPPED["film"])))
        trainer = self.trainer("film", "--steps", "2", "--network", "film", "--depths", "0,1,2,2,2", shape=())
        self.assertEqual(trainer.shape, network.SHAPES["film"]._replace(depths=(0, 1, 2, 2, 2)))
        self.ends(2, "was trained with --widths 48,", self.trainer, "a", *film, shape=())
        self.ends(2, "not allowed with --resume", self.trainer, "run", "--steps", "2", "--resume", "--start", "a")

    def test_goes_on_only_with_the_same_network(self):
        self.train("run", "--steps", "2")
        with mock.patch.object(train, "Workers", side_effect=AssertionError):  # before workers are connected
            for name, value in ("widths", "8,24"), ("depths", "1,1"), ("kernels", "5,3"):
                shape = dict(zip(SMALL[::2], SMALL[1::2]))
                text = f"was trained with --{name} {shape['--' + name]}, not {value}"
                self.ends(2, text, self.trainer, "run", "--steps", "2", "--resume", "--" + name, value)
            self.ends(2, "--widths 8,16, not 16,32", self.trainer, "run", "--steps", "2", "--resume", shape=())
            self.ends(2, "--resume continues it", self.trainer, "run", "--steps", "2")
            self.ends(3, "there is no checkpoint", self.trainer, "none", "--steps", "2", "--resume")
            none = self.path("none.pt")
            self.ends(3, none + ": there is no checkpoint", self.trainer, "none", "--steps", "2", "--start", none)
        self.assertFalse(os.path.exists(self.path("none")))
        self.train("run", "--steps", "2", "--overwrite", "--kernels", "5,3")

    def test_other_options_and_data_are_refused(self):
        self.ends(2, "different numbers of levels", self.trainer, "run", "--steps", "2", "--widths", "8")
        self.ends(2, "even width", self.trainer, "run", "--steps", "2", "--kernels", "3,4")
        self.ends(2, "required", self.trainer, "run")
        self.data = nano_clips.make_clips(self.path("stills"), files=1, rows=4, columns=4, sequence=False)
        self.ends(3, "has stills", self.trainer, "run", "--steps", "2")
        self.data = self.path("nothing")
        self.ends(3, "manifest.json", self.trainer, "run", "--steps", "2")

    def test_a_checkpoint_is_replaced_only_by_a_complete_one(self):
        self.train("run", "--steps", "2")
        before = checkpoint.load(self.path("run"))

        def cut(state, stream):
            stream.write(b"half")
            raise OSError("no space left")

        with mock.patch.object(torch, "save", cut), self.assertRaises(OSError):
            self.train("run", "--steps", "4", "--resume")
        self.assertEqual(checkpoint.load(self.path("run"))["step"], before["step"])

        trainer = self.trainer("run", "--steps", "4", "--resume")
        trainer.net.inp.bias.data[0] = float("nan")
        with self.assertRaisesRegex(SystemExit, "no finite numbers"), contextlib.redirect_stdout(io.StringIO()):
            trainer.run()
        self.assertEqual(checkpoint.load(self.path("run"))["step"], before["step"])

    def test_two_workers_average_their_gradients(self):
        output = together.start_workers(self, 2, "limpid_training.nano.train", *self.options("run", "--steps", "1"))
        self.assertIn("step 1", output[0])
        self.assertNotIn("step", output[1], "only the first worker reports")
        trainer = self.trainer("alone", "--steps", "1")
        gradients = []
        for number in (0, 1):
            trainer.workers.number = number
            trainer.use([clips.load(self.data, "cpu", number, 2)])
            trainer.optimizer.zero_grad()
            trainer.loss(trainer.batch()).backward()
            gradients.append([weight.grad.clone() for weight in trainer.net.parameters()])
        for weight, mine, yours in zip(trainer.net.parameters(), *gradients):
            weight.grad = (mine + yours) / 2
        torch.nn.utils.clip_grad_norm_(trainer.net.parameters(), train.LARGEST_GRADIENT)
        of_adam = checkpoint.load(self.path("run"))["opt"]["state"].values()
        for weight, mine, state in zip(trainer.net.parameters(), gradients[0], of_adam):
            self.assertTrue(torch.allclose(state["exp_avg"], 0.1 * weight.grad, rtol=1e-3, atol=1e-9))
            self.assertFalse(torch.allclose(state["exp_avg"], 0.1 * mine, rtol=1e-3, atol=1e-9))


class FileTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        torch.manual_seed(4)
        self.weights = network.Net().state_dict()

    def path(self, name):
        return os.path.join(self.folder, name)

    def save(self, **more):
        torch.save({"net": self.weights, **more}, self.path("checkpoint.pt"))
        return self.folder

    def data_of(self, path):
        with open(path, "rb") as stream:
            content = stream.read()
        return content[8 + int.from_bytes(content[:8], "little") :]

    def test_weights_come_back_as_halves(self):
        file = self.path("w.safetensors")
        for network_name, shape in network.SHAPES.items():
            self.weights = network.Net(shape).state_dict()
            self.assertEqual(export.export(self.save(step=7), file), network_name)
            back = weights.network_in(file).state_dict()
            self.assertEqual(back.keys(), self.weights.keys())
            for name, weight in self.weights.items():
                self.assertTrue(torch.equal(back[name], weight.half().float()), name)
            _, metadata = tensor_file.read(file)
            self.assertEqual(metadata["limpid.network"], network_name)
            self.assertEqual(json.loads(metadata["limpid.training"])["steps"], 7)

    def test_metadata_tell_of_the_training_and_not_of_the_call(self):
        def told(**state):
            return json.loads(export.metadata_of("nano", state)["limpid.training"])

        self.assertEqual(told(options={"start": "a", "clips": ["b"], "rate": 1})["options"], {"rate": 1})
        self.assertEqual(told(datasets=[{"seed": 1}, {"seed": 2}])["datasets"], [{"seed": 1}, {"seed": 2}])
        self.assertEqual(told(dataset={"seed": 3})["datasets"], [{"seed": 3}], "as older checkpoints have it")
        self.assertEqual(told()["datasets"], [])

    def test_means_over_steps_are_exported(self):
        means = [weight + 1 for weight in self.weights.values()]
        export.export(self.save(ema=means), self.path("w.safetensors"))
        back = weights.network_in(self.path("w.safetensors")).state_dict()
        self.assertTrue(torch.equal(back["heads.4.bias"], torch.ones(18)))

    def test_the_shipped_file_is_what_this_code_makes(self):
        for name, shipped in compare.SHIPPED.items():
            self.assertEqual(export.export(shipped, self.path("w.safetensors")), name)
            self.assertEqual(self.data_of(self.path("w.safetensors")), self.data_of(shipped), name)
            self.assertEqual(tensor_file.read(self.path("w.safetensors"))[1]["limpid.network"], name)

    def test_numbers_are_where_the_library_reads_them(self):
        """As nano_network.h states it, number by number."""
        tensors = weights.to_file(self.weights)
        self.assertEqual(list(tensors)[:4], ["level 0/halve", "level 1/halve", "level 1/around 0", "level 2/halve"])
        self.assertEqual(list(tensors)[9:14], ["level 4/halve", "level 4/around 0", "level 4/around 1", "level 0/join",
                                               "level 0/after"])
        self.assertEqual(list(tensors)[-1], "level 4/logits")

        def number(tensor, outputs, inputs, tap, i, o):
            texel = outputs // 8 + ((tap * (inputs // 8) + i // 8) * (outputs // 8) + o // 8) * 8 + i % 8
            return tensor[texel, o % 8].item()

        layers = (("level 2/around 1", "enc.2.1", 48, 48, 3), ("level 3/halve", "down.2", 64, 48, 2),
                  ("level 1/join", "mix.1", 32, 80, 1))
        for name, layer, outputs, inputs, taps in layers:
            for tap, i, o in (0, 0, 0), (taps * taps - 1, 9, 23), (taps // 2, inputs - 1, outputs - 1):
                expected = self.weights[layer + ".weight"][o, i, tap // taps, tap % taps]
                self.assertEqual(number(tensors[name], outputs, inputs, tap, i, o), expected.half().item())
            self.assertEqual(tensors[name][1, 2], self.weights[layer + ".bias"][10].half())
        # 14 logits of each signal, in two groups of eight.
        for signal, logit in (0, 13), (1, 0), (1, 13):
            expected = self.weights["heads.3.weight"][14 * signal + logit, 40, 0, 0].half().item()
            self.assertEqual(number(tensors["level 3/logits"], 32, 64, 0, 40, 16 * signal + logit), expected)
        self.assertEqual(number(tensors["level 3/logits"], 32, 64, 0, 40, 15), 0)

    def test_what_cannot_be_used_is_refused(self):
        output = self.path("w.safetensors")
        told = io.StringIO()
        with contextlib.redirect_stderr(told):
            self.weights = network.Net(network.Shape((8, 16), (0, 1), (3, 3))).state_dict()
            with self.assertRaises(SystemExit):
                export.export(self.save(), output)
        self.assertIn("Limpid computes only", told.getvalue())
        self.weights = network.Net().state_dict()
        self.weights["mix.2.bias"][3] = 1e6
        with self.assertRaisesRegex(SystemExit, "level 2/join"):
            export.export(self.save(), output)
        self.assertFalse(os.path.exists(output))
        for content in {"a": torch.zeros(1)}, {"level 0/halve": torch.zeros(3, 8)}:
            tensor_file.write(output, content)
            with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(told):
                weights.read(output)
            self.assertEqual(ended.exception.code, 3)
        self.assertIn("has no weights of 'nano' or 'film'", told.getvalue())


if __name__ == "__main__":
    unittest.main()
