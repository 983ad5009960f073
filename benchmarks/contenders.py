"""Two renderers behind one call: `render(spp, seed, sampler)` takes a picture of the loaded scene, timed."""

import json
import multiprocessing
import resource
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scenes import scene_dict

# Pixels along a side of every picture.
SIZE = 256
# A wavefront of the LLVM backend keeps the state of all its paths in memory.
MITSUBA_SPP_PER_CALL = 64


@dataclass
class Shot:
    """A picture, linear radiance, (SIZE, SIZE, 3) in f64, and its cost."""

    image: np.ndarray
    spp: int
    seconds: float
    # Processor time, summed over threads: what else the machine does counts little.
    processor_seconds: float


class Twinlight:
    """The command, a process per picture. Its kernel time is in the JSON file that it writes beside the picture."""

    name = "twinlight"
    samplers = ("sobol", "independent")

    def __init__(self, command: Path, folder: Path):
        self.command, self.folder, self.scene = command, folder, ""

    def load(self, scene: str, _exported: Path) -> None:
        self.scene = scene
        # What a process costs beside the samples after the first. The least of three: noise only adds.
        self.fixed_processor_seconds = min(self._run(1, 0, "sobol")[1] for _ in range(3))

    def render(self, spp: int, seed: int, sampler: str = "sobol") -> Shot:
        seconds, processor_seconds = self._run(spp, seed, sampler)
        extra = max(processor_seconds - self.fixed_processor_seconds, 1e-9) * spp / max(spp - 1, 1)
        return Shot(read_image(self.folder / "picture.exr"), spp, seconds, extra)

    def _run(self, spp: int, seed: int, sampler: str) -> tuple[float, float]:
        before = children_seconds()
        words = [self.command, "render", self.scene, "-o", self.folder / "picture.exr"]
        words += ["--backend", "cpu", "--size", f"{SIZE}x{SIZE}", "--bounces", "unlimited", "--progress", "never"]
        words += ["--spp", str(spp), "--seed", str(seed), "--sampler", sampler]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
        sidecar = json.loads((self.folder / "picture.json").read_text())
        return sidecar["seconds"]["trace_paths"], children_seconds() - before


class Mitsuba:
    """Mitsuba in a process of its own, so that variants share no threads and processor time can be told apart."""

    samplers = ("independent",)

    def __init__(self, variant: str):
        self.name = f"Mitsuba {variant}"
        # `spawn`: neither Mitsuba's threads nor its just-in-time compiler survive a fork.
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=serve, args=(variant, theirs), daemon=True)
        self.process.start()
        theirs.close()

    def load(self, _scene: str, exported: Path) -> None:
        self._ask(("load", exported))
        # Compiles the kernels of the LLVM variant.
        self.render(MITSUBA_SPP_PER_CALL, 0)

    def render(self, spp: int, seed: int, _sampler: str = "independent") -> Shot:
        return self._ask(("render", spp, seed))

    def _ask(self, request):
        self.pipe.send(request)
        try:
            return self.pipe.recv()
        except EOFError as error:
            raise SystemExit(f"{self.name} ended without an answer; its error is above") from error


def children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def read_image(path: Path) -> np.ndarray:
    """The channels R, G, B of an EXR file, beside whatever other layers it has."""
    import mitsuba as mi

    bitmap = mi.Bitmap(str(path))
    names = [field.name for field in bitmap.struct_()]
    pixels = np.array(bitmap).reshape(bitmap.height(), bitmap.width(), len(names))
    return pixels[:, :, [names.index(name) for name in "RGB"]].astype(np.float64)


def serve(variant: str, pipe) -> None:
    """The loop of a Mitsuba process."""
    import mitsuba as mi

    mi.set_variant(variant)
    scene = None
    while True:
        try:
            word, *arguments = pipe.recv()
        except EOFError:
            return
        if word == "load":
            scene = mi.load_dict(scene_dict(mi, arguments[0], SIZE))
            pipe.send(None)
        else:
            pipe.send(shoot(mi, scene, *arguments))


def shoot(mi, scene, spp: int, seed: int) -> Shot:
    """Renders in calls of at most MITSUBA_SPP_PER_CALL samples and averages them."""
    image, done, call = np.zeros((SIZE, SIZE, 3)), 0, 0
    start, processor_start = time.perf_counter(), time.process_time()
    while done < spp:
        count = min(MITSUBA_SPP_PER_CALL, spp - done)
        # Each call of each seed its own stream.
        picture = mi.render(scene, spp=count, seed=(seed << 12) + call)
        image += np.array(picture, dtype=np.float64) * count
        done, call = done + count, call + 1
    return Shot(image / spp, spp, time.perf_counter() - start, time.process_time() - processor_start)
