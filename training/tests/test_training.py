import contextlib
import io
import json
import os
import tempfile
import unittest
from unittest import mock
from xml.etree import ElementTree

import torch

from limpid_training import compare, data, evaluate, export, features, pictures, tensor_file, train
from limpid_training.network import Kpcn

from . import first_gradients, together

LAYERS = {"diffuse": 3, "specular": 3, "albedo": 3, "normal": 3, "depth": 1}


def make_dataset(folder, examples=6, rows=24, columns=20, samples=4):
    """Writes a data set in the format of `limpid dataset`: smooth light on a checkerboard albedo, with noise."""
    generator = torch.Generator().manual_seed(5)
    files = []
    for number in range(examples // 2):
        tensors, names = {}, []
        for name in (f"{2 * number:06}", f"{2 * number + 1:06}"):
            y, x = torch.meshgrid(torch.arange(float(rows)), torch.arange(float(columns)), indexing="ij")
            albedo = (0.2 + 0.6 * ((x // 4 + y // 4) % 2)).expand(3, -1, -1)
            light = (1 + torch.sin(0.2 * x + number)).expand(3, -1, -1)
            clean = {"diffuse": albedo * light, "specular": 0.3 * light}
            layers = dict(clean, albedo=albedo, normal=torch.zeros(3, rows, columns), depth=(1 + y).unsqueeze(0))
            layers["normal"][1] = 1.0
            for layer, image in layers.items():
                noisy = image * (1 + torch.rand(image.shape, generator=generator) - 0.5) if layer in clean else image
                tensors[f"{name}/{samples}/{layer}"] = noisy.half()
                tensors[f"{name}/{samples}/{layer}.variance"] = torch.full((1, rows, columns), 0.05).half()
            for side in clean:
                tensors[f"{name}/reference/{side}"] = clean[side].half()
            names.append({"name": name, "scene": "builtin:room-" + name})
        file = f"examples.{number:05}.safetensors"
        tensor_file.write(os.path.join(folder, file), tensors)
        files.append({"name": file, "examples": names})
    with open(os.path.join(folder, "manifest.json"), "w") as stream:
        json.dump({"dataset": {"samples": [samples]}, "files": files}, stream)


class TrainingTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.data = os.path.join(self.folder, "data")
        os.mkdir(self.data)
        make_dataset(self.data)

    def options(self, run, *more):
        small = "--samples 4 --hidden 1 --channels 6 --width 5 --patch 12 --patches 4 --batch 4 --device cpu"
        rates = "--rate-diffuse 1e-2 --rate-specular 1e-2 --rate-tuning 1e-3"
        return [self.data, "-o", os.path.join(self.folder, run), *small.split(), *rates.split(), *more]

    def train(self, run, *more):
        trainer = train.Trainer(train.parse(self.options(run, *more)))
        return trainer.run(), trainer

    def test_patches_are_cut_from_the_frame(self):
        frame = data.Dataset(self.data, 4)[0]
        whole = features.prepare(frame)
        for patch in data.patches(whole, frame, 12, 5, torch.Generator().manual_seed(1)):
            self.assertEqual(patch["diffuse.input"].shape, (1, features.INPUT_CHANNELS, 12, 12))
            windows = whole["target"].unfold(2, 12, 1).unfold(3, 12, 1)
            self.assertTrue((windows == patch["target"].unsqueeze(2).unsqueeze(2)).all(-1).all(-1).all(1).any())

    def test_varied_frames_are_other_views_of_the_same(self):
        frame = data.Dataset(self.data, 4)[0]
        generator = torch.Generator().manual_seed(3)
        shapes = set()
        for _ in range(12):
            varied = data.varied(frame, generator)
            shapes.add(tuple(varied["depth"].shape[2:]))
            brighter = varied["diffuse"].sum() / frame["diffuse"].sum()
            for name, power in (("reference.specular", 1), ("diffuse.variance", 2), ("albedo", 0), ("normal", 0)):
                ratio = (varied[name].sum() / frame[name].sum()).item()
                self.assertAlmostEqual(ratio / brighter.item() ** power, 1.0, places=3, msg=name)
            light = (varied["reference.diffuse"] / varied["albedo"]).mean() / brighter
            self.assertAlmostEqual(light.item(), (frame["reference.diffuse"] / frame["albedo"]).mean().item(), places=3)
        self.assertEqual(shapes, {(24, 20), (20, 24)})

    def test_held_out_examples_are_spread(self):
        self.assertEqual(train.split(6, 1), ([0, 1, 2, 3, 4], [5]))
        learnt, validated = train.split(100, 7)
        self.assertEqual(sorted(learnt + validated), list(range(100)))
        self.assertEqual(len(validated), 7)
        self.assertLess(max(b - a for a, b in zip(validated, validated[1:])), 16)
        for held_out in 60, 300:  # every second example has rays through the pixels' centres
            learnt, validated = train.split(600, held_out)
            self.assertEqual((len(validated), sum(i % 2 for i in validated)), (held_out, held_out // 2))
            self.assertEqual(sorted(learnt + validated), list(range(600)))

    def test_losses_that_are_no_numbers_stop_it(self):
        with self.assertRaisesRegex(SystemExit, "'diffuse' are no finite numbers"):
            self.train("run", "--epochs", "3", "--rate-diffuse", "1e30", "--warm-up", "0")

    def test_other_numbers_of_samples_are_refused(self):
        with self.assertRaisesRegex(ValueError, "none of 32"):
            data.Dataset(self.data, 32)

    def test_learns_and_leaves_what_it_learnt(self):
        losses, trainer = self.train("run", "--epochs", "6", "--tuning-epochs", "2")
        self.assertEqual([len(losses[name]) for name in ("diffuse", "specular", "both", "validation")], [6, 6, 2, 8])
        self.assertLess(losses["validation"][-1], 0.85 * losses["validation"][0])
        run = os.path.join(self.folder, "run")
        for name in ("checkpoint.pt", "losses.json", "losses.svg", "validation.png"):
            self.assertGreater(os.path.getsize(os.path.join(run, name)), 100, name)

        judged = list(evaluate.evaluate(run, self.data))
        self.assertEqual(len(judged), 6)
        for scene, noisy, denoised in judged:
            self.assertLess(denoised, 0.9 * noisy, scene)
        told = io.StringIO()
        with mock.patch("sys.argv", ["evaluate", run, self.data, "--device", "cpu"]), contextlib.redirect_stdout(told):
            evaluate.main()
        self.assertIn("5 of the 6 scenes were trained on", told.getvalue())

        file = os.path.join(self.folder, "weights.safetensors")
        export.export(run, file)
        weights, metadata = tensor_file.read(file)
        self.assertEqual(metadata["limpid.network"], "kpcn")
        net = Kpcn(**json.loads(metadata["limpid.shape"]))
        net.load_state_dict({name: weight.float() for name, weight in weights.items()})
        prepared = features.prepare(trainer.examples[0])
        with torch.no_grad():
            difference = (net(prepared) - trainer.net(prepared)).abs().max().item()
        self.assertLess(difference, 1e-2)

        state = torch.load(os.path.join(run, "checkpoint.pt"))
        state["net"]["specular.output.bias"][0] = 1e6
        torch.save(state, os.path.join(run, "checkpoint.pt"))
        with self.assertRaisesRegex(SystemExit, "specular.output.bias"):
            export.export(run, file)

    def test_goes_on_where_it_was_stopped(self):
        _, whole = self.train("whole", "--epochs", "3", "--tuning-epochs", "1", "--vary")
        losses, _ = self.train("parts", "--epochs", "3", "--tuning-epochs", "1", "--vary", "--time-limit", "0.001")
        self.assertEqual(len(losses["validation"]), 1)
        losses, parts = self.train("parts", "--epochs", "3", "--tuning-epochs", "1", "--vary", "--resume")
        self.assertEqual(len(losses["validation"]), 4)
        for a, b in zip(whole.net.parameters(), parts.net.parameters()):
            self.assertTrue(torch.equal(a, b))

    def ends(self, code, text, call, *arguments):
        """Checks the exit code and the message of a program that a call ends."""
        told = io.StringIO()
        with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(told):
            call(*arguments)
        self.assertEqual(ended.exception.code, code)
        self.assertIn(text, told.getvalue())

    def test_an_existing_checkpoint_is_replaced_only_if_told(self):
        epochs = ("--epochs", "2", "--tuning-epochs", "0", "--time-limit", "0.001")
        self.train("run", *epochs)
        with open(os.path.join(self.folder, "run", "checkpoint.pt"), "rb") as stream:
            before = stream.read()
        self.ends(2, "--resume continues it, --overwrite replaces it", self.train, "run", *epochs)
        with open(os.path.join(self.folder, "run", "checkpoint.pt"), "rb") as stream:
            self.assertEqual(stream.read(), before)
        losses, _ = self.train("run", *epochs, "--overwrite")
        self.assertEqual(len(losses["validation"]), 1)
        self.ends(2, "not allowed with", self.train, "run", *epochs, "--overwrite", "--resume")

    def test_a_missing_checkpoint_is_named(self):
        run, text = os.path.join(self.folder, "none"), os.path.join("none", "checkpoint.pt") + ": there is no"
        self.ends(3, text, self.train, "none", "--resume")
        self.assertFalse(os.path.exists(run))
        self.ends(3, text, export.export, run, os.path.join(self.folder, "w.safetensors"))
        self.ends(3, text, list, evaluate.evaluate(run, self.data))

    def test_a_damaged_checkpoint_is_named(self):
        self.train("run", "--epochs", "1", "--tuning-epochs", "0")
        run, text = os.path.join(self.folder, "run"), os.path.join("run", "checkpoint.pt") + ": cannot be read"
        with open(os.path.join(run, "checkpoint.pt"), "rb+") as stream:
            whole = stream.read()
            for damaged in whole[:-1000], whole[:1000], b"":
                stream.seek(0)
                stream.truncate()
                stream.write(damaged)
                stream.flush()
                self.ends(3, text, self.train, "run", "--resume")
        self.ends(3, text, export.export, run, os.path.join(self.folder, "w.safetensors"))
        self.ends(3, text, list, evaluate.evaluate(run, self.data))

    def test_checkpoints_are_looked_at_before_workers_are_connected(self):
        self.train("run", "--epochs", "1", "--tuning-epochs", "0")
        with mock.patch.object(train, "Workers", side_effect=AssertionError):
            self.ends(2, "--resume continues it", self.train, "run")
            self.ends(2, "--hidden", self.train, "run", "--resume", "--hidden", "2")
            self.ends(3, "there is no", self.train, "none", "--resume")

    def test_goes_on_only_with_the_same_network_and_examples(self):
        epochs = ("--epochs", "2", "--tuning-epochs", "0")
        self.train("run", *epochs, "--time-limit", "0.001")
        for option in ("--facing", "-2"), ("--hidden", "2"), ("--diffuse-input", "linear"), ("--inputs", "gradients"):
            self.ends(2, "was trained with " + option[0], self.train, "run", *epochs, "--resume", *option)
        self.ends(2, "--validation", self.train, "run", *epochs, "--resume", "--validation", "0.5")

    def test_weights_that_are_no_numbers_replace_no_checkpoint(self):
        self.train("run", "--epochs", "2", "--time-limit", "0.001")
        trainer = train.Trainer(train.parse(self.options("run", "--epochs", "2", "--resume")))

        def step(side, batch):
            trainer.net.diffuse.output.bias.data[0] = float("nan")
            return torch.tensor(0.5)

        checkpoint = os.path.join(self.folder, "run", "checkpoint.pt")
        with mock.patch.object(trainer, "step", step), self.assertRaisesRegex(SystemExit, "weights"):
            trainer.run()
        state = torch.load(checkpoint)
        self.assertEqual(state["epoch"], 1)
        self.assertTrue(torch.isfinite(state["net"]["diffuse.output.bias"]).all())

    def test_turned_pictures_may_be_smaller_than_a_patch(self):
        losses, _ = self.train("run", "--epochs", "1", "--tuning-epochs", "0", "--vary", "--patch", "128")
        self.assertEqual(len(losses["diffuse"]), 1)

    def test_more_processes_than_examples_are_refused(self):
        workers = mock.Mock(count=8, number=0, device=torch.device("cpu"))
        options = train.parse(self.options("run"))
        with mock.patch.object(train, "Workers", return_value=workers):
            self.ends(2, "8 proc", train.Trainer, options)

    def test_other_options_that_do_not_fit_are_refused(self):
        self.ends(2, "needs --loss absolute", self.train, "run", "--direct")
        self.ends(2, "6 examples are too few", self.train, "run", "--validation", "1")

    def test_stops_in_time(self):
        losses, _ = self.train("run", "--epochs", "1000", "--time-limit", "0.01")
        self.assertEqual(len(losses["validation"]), 1)

    def test_presets_may_be_changed(self):
        options = train.parse(["data", "-o", "run", "--preset", "cis565", "--batch", "8"])
        self.assertEqual((options.epochs, options.rate_diffuse, options.batch), (10, 1e-5, 8))

    def test_kernels_against_colours(self):
        """A network that predicts colours can be trained and plotted beside one that predicts kernels, but not
        exported."""
        runs = {}
        for name, extra in (("kernels", ()), ("colours", ("--direct",))):
            self.train(name, "--epochs", "2", "--tuning-epochs", "0", "--loss", "absolute", *extra)
            runs[name] = compare.read(os.path.join(self.folder, name))
            self.assertEqual(len(runs[name]["times"]), 2)
        self.assertEqual(len(list(compare.table(runs))), 2)
        plot = os.path.join(self.folder, "plot.svg")
        pictures.write_plots(plot, compare.plots(runs))
        with open(plot) as stream:
            self.assertIn("colours, specular", stream.read())
        with self.assertRaises(SystemExit):
            export.export(os.path.join(self.folder, "colours"), os.path.join(self.folder, "w.safetensors"))

    def train_together(self, count, run, *more):
        return together.start_workers(self, count, "limpid_training.train", *self.options(run, *more))

    def losses_of(self, run):
        with open(os.path.join(self.folder, run, "losses.json")) as stream:
            return json.load(stream)["losses"]

    def test_two_workers(self):
        output = self.train_together(2, "run", "--epochs", "2", "--tuning-epochs", "1")
        self.assertIn("epoch 3 of 3", output[0])
        self.assertNotIn("epoch", output[1], "only the first worker reports")

    def test_two_workers_average_their_gradients(self):
        trainer = train.Trainer(train.parse(self.options("alone")))
        expected = []
        for number in (0, 1):
            trainer.workers.count, trainer.workers.number = 2, number
            expected.append(first_gradients.of(trainer))
        file = os.path.join(self.folder, "gradients.pt")
        together.start_workers(self, 2, "tests.first_gradients", file, *self.options("together"))
        for mine, yours, mean in zip(*expected, torch.load(file)):
            self.assertGreater((mine - yours).abs().max(), 0)
            self.assertTrue(torch.allclose(mean, (mine + yours) / 2, rtol=1e-3, atol=1e-7))

    def test_goes_on_with_another_number_of_workers(self):
        epochs = ("--epochs", "3", "--tuning-epochs", "1")
        self.train_together(2, "run", *epochs, "--time-limit", "0.001")
        self.assertEqual(len(self.losses_of("run")["validation"]), 1)
        losses, trainer = self.train("run", *epochs, "--resume", "--time-limit", "0.001")
        self.assertEqual(len(losses["validation"]), 2)
        self.train_together(2, "run", *epochs, "--resume")
        losses = self.losses_of("run")
        self.assertEqual([len(losses[name]) for name in ("diffuse", "both", "validation")], [3, 1, 4])
        self.assertLess(losses["validation"][-1], losses["validation"][0])


class CompareTest(unittest.TestCase):
    def test_runs_of_the_same_name_have_their_paths(self):
        self.assertEqual(compare.labels(["a/run/", "b"]), ["run", "b"])
        self.assertEqual(compare.labels(["a/run/", "b/run"]), ["a/run", "b/run"])


class RelMseTest(unittest.TestCase):
    def test_is_the_formula(self):
        image, reference = torch.tensor([1.0, 0.3]), torch.tensor([2.0, 0.0])
        self.assertAlmostEqual(evaluate.rel_mse(image, reference), (1 / 4.01 + 0.09 / 0.01) / 2, places=5)


class PicturesTest(unittest.TestCase):
    def test_names_with_markup_stay_text(self):
        with tempfile.TemporaryDirectory() as folder:
            plot = os.path.join(folder, "plot.svg")
            pictures.write_plots(plot, [("Loss", "epoch", {"a<b & c": ([1, 2], [0.5, 0.25])})])
            self.assertIn("a<b & c", "".join(ElementTree.parse(plot).getroot().itertext()))

    def test_black_stays_black(self):
        self.assertEqual(pictures.shown(torch.zeros(3, 2, 2)).abs().sum().item(), 0)


if __name__ == "__main__":
    unittest.main()
