"""One veil of every pixel, by vglare and by what else could do it; README.md says how to run it."""

import argparse
import datetime
import json
import math
import os
import platform
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
import scipy
import scipy.fft

THREADS = 2
AGE, PIGMENT, FIELD = 25.0, 0.5, 50.0
# CIE 146's equation as the veil has it: flat within 0.1 degree, its light counted to 100.
FLAT, END = 0.1, 100.0


def glare_function(angle):
    """CIE 146:2002's general disability glare equation per steradian, of angles in degrees."""
    angle, age = np.maximum(angle, FLAT), 1.0 + (AGE / 62.5) ** 4
    return 10.0 / angle**3 + (5.0 / angle**2 + 0.1 * PIGMENT / angle) * age + 0.0025 * PIGMENT


def scattered():
    """The share of the light that it scatters, by Gauss and Legendre in the angle's logarithm."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    low, high = math.log(FLAT), math.log(END)
    angle = np.exp(low + (high - low) * 0.5 * (nodes + 1.0))
    ring = 2.0 * np.pi * np.sin(np.radians(angle)) * glare_function(angle) * np.radians(angle)
    cap = 2.0 * np.pi * (1.0 - math.cos(math.radians(FLAT))) * glare_function(FLAT)
    return float(cap + np.sum(weights * ring) * 0.5 * (high - low))


class Photo:
    """A night of lamps before dim, rough walls, as PFM: the same on every machine."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        chance = np.random.default_rng(7)
        walls = chance.normal(size=(height // 40 + 2, width // 40 + 2, 3))
        walls = cv2.resize(walls, (width, height), interpolation=cv2.INTER_CUBIC)
        photo = 0.05 * np.exp(0.8 * walls + 0.2 * chance.normal(size=(height, width, 1)))
        for _ in range(30):
            x, y, radius = chance.integers(width), chance.integers(height), int(chance.integers(1, 9))
            colour = tuple(10.0 ** chance.uniform(1, 4) * chance.uniform(0.5, 1.0, 3))
            cv2.circle(photo, (int(x), int(y)), radius, colour, -1)
        self.pixels = photo.astype(np.float32)
        focal = 0.5 * width / math.tan(math.radians(0.5 * FIELD))
        self.pitch, self.solid_angle = math.degrees(1.0 / focal), 1.0 / focal**2

    def kernel(self):
        """What a pixel sends to all offsets, in 64 bits: twice the picture less one pixel, nothing in its middle."""
        across, down = [np.arange(1 - side, side, dtype=np.float64) for side in (self.width, self.height)]
        kernel = self.solid_angle * glare_function(self.pitch * np.hypot(across[None, :], down[:, None]))
        kernel[self.height - 1, self.width - 1] = 0.0
        return kernel

    def veil_at(self, pixels):
        """The definition in 64 bits at columns and rows."""
        kernel, photo = self.kernel(), self.pixels.astype(np.float64)
        w, h = self.width, self.height
        # The kernel is its own mirror image, so that sources and targets may change places.
        at = lambda x, y: np.einsum("yxc,yx->c", photo, kernel[h - 1 - y : 2 * h - 1 - y, w - 1 - x : 2 * w - 1 - x])
        return np.array([at(x, y) for x, y in pixels])

    def crops(self):
        """Pixels of the four corners, around the brightest, in the darkest and by chance: 8 x 8 each."""
        light = self.pixels.sum(axis=2)
        w, h, side = self.width, self.height, 8
        corners = [(0, 0), (w - side, 0), (0, h - side), (w - side, h - side)]
        extremes = [np.unravel_index(index, light.shape)[::-1] for index in (light.argmax(), light.argmin())]
        some = np.random.default_rng(1).integers((w, h), size=(2, 2))
        firsts = [(min(int(x), w - side), min(int(y), h - side)) for x, y in [*corners, *extremes, *some]]
        return [(x + i, y + j) for x, y in firsts for j in range(side) for i in range(side)]


def read_pfm(path):
    with open(path, "rb") as file:
        assert file.readline().strip() == b"PF"
        width, height = map(int, file.readline().split())
        kind = "<f4" if float(file.readline()) < 0 else ">f4"
        return np.fromfile(file, kind).reshape(height, width, 3)[::-1].astype(np.float32)


def write_pfm(path, pixels):
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (pixels.shape[1], pixels.shape[0]))
        np.ascontiguousarray(pixels[::-1], "<f4").tofile(file)


class Scipy:
    """A padded transform: the period is twice the picture, as the kernel reaches from edge to edge."""

    def __init__(self, workers, kind):
        self.workers, self.kind = workers, kind
        self.name = f"scipy.fft, {np.dtype(kind).itemsize * 8} bits, workers = {workers}"

    def prepare(self, photo):
        h, w = photo.height, photo.width
        self.period = [scipy.fft.next_fast_len(2 * side - 1, real=True) for side in (h, w)]
        around = np.zeros(self.period, self.kind)
        kernel = photo.kernel()
        # Offsets below 0 stand at the end of the period.
        around[: 2 * h - 1, : 2 * w - 1] = kernel
        around = np.roll(around, (1 - h, 1 - w), (0, 1))
        self.gain = scipy.fft.rfft2(around, workers=self.workers)

    def convolve(self, pixels):
        planes = np.ascontiguousarray(np.moveaxis(pixels, 2, 0)).astype(self.kind, copy=False)
        modes = scipy.fft.rfft2(planes, s=self.period, workers=self.workers)
        modes *= self.gain
        whole = scipy.fft.irfft2(modes, s=self.period, workers=self.workers, overwrite_x=True)
        return np.moveaxis(whole[:, : pixels.shape[0], : pixels.shape[1]], 0, 2)


class Dft:
    """OpenCV's transform, channel by channel."""

    name = "cv2.dft"

    def prepare(self, photo):
        h, w = photo.height, photo.width
        self.period = [cv2.getOptimalDFTSize(2 * side - 1) for side in (h, w)]
        around = np.zeros(self.period, np.float32)
        around[: 2 * h - 1, : 2 * w - 1] = photo.kernel()
        self.gain = cv2.dft(np.roll(around, (1 - h, 1 - w), (0, 1)))

    def convolve(self, pixels):
        h, w = pixels.shape[:2]
        veil = np.empty_like(pixels)
        plane = np.zeros(self.period, np.float32)
        for channel in range(3):
            plane[:] = 0.0
            plane[:h, :w] = pixels[..., channel]
            modes = cv2.mulSpectrums(cv2.dft(plane, nonzeroRows=h), self.gain, 0)
            veil[..., channel] = cv2.dft(modes, flags=cv2.DFT_INVERSE | cv2.DFT_SCALE, nonzeroRows=h)[:h, :w]
        return veil


class Filter:
    """`cv2.filter2D` with the kernel as it is, which OpenCV takes tile by tile through its transform."""

    name = "cv2.filter2D"

    def prepare(self, photo):
        self.kernel = photo.kernel().astype(np.float32)

    def convolve(self, pixels):
        return cv2.filter2D(pixels, -1, self.kernel, borderType=cv2.BORDER_CONSTANT)


class Vglare:
    """`vglare apply` with its report."""

    def __init__(self, program, tolerance):
        self.program, self.tolerance = program, tolerance
        self.name = f"vglare, to {tolerance:g}"

    def run(self, source, folder, glare=False):
        report, out = folder / "report.json", folder / "out.pfm"
        command = [self.program, "apply", source, "-o", out, "--report", report, "--lens", "none", "--veil", "cie",
                   "--age", AGE, "--pigment", PIGMENT, "--fov", FIELD, "--projection", "planar", "--tolerance",
                   self.tolerance, "--force", "--quiet"]
        command += ["--glare", folder / "veil.pfm"] if glare else []
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        started = time.perf_counter()
        subprocess.run([str(part) for part in command], check=True)
        wall = 1e3 * (time.perf_counter() - started)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        busy = 1e3 * (after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
        told = json.loads(report.read_text())
        stages = {stage["stage"]: stage["wall_ms"] for stage in told["milliseconds"]}
        self.predicted = told["veil"]["error"]["predicted"]
        return {"plan": stages["veil plan"], "veil": stages["veil"], "check": stages["veil certify"], "whole": wall,
                "busy": busy}

    def veil(self, source, folder):
        self.run(source, folder, glare=True)
        return read_pfm(folder / "veil.pfm")


def whole_run(way, photo, source, folder):
    """What a script would do: read, prepare, convolve, lay the veil over the photo, write; without Python's start."""
    busy, started = time.process_time(), time.perf_counter()
    pixels = read_pfm(source)
    reading = time.perf_counter()
    way.prepare(photo)
    prepared = time.perf_counter()
    veil = way.convolve(pixels)
    convolved = time.perf_counter()
    keep = 1.0 - SCATTERED + photo.solid_angle * float(glare_function(0.0))
    write_pfm(folder / "peer.pfm", np.float32(keep) * pixels + veil)
    ended = time.perf_counter()
    steps = {"plan": prepared - reading, "veil": convolved - prepared, "whole": ended - started,
             "busy": time.process_time() - busy}
    return {name: 1e3 * value for name, value in steps.items()}


def error(veil, pixels, exact):
    """Relative to the veil at each pixel, the worst of all channels, and how many of the values are not above 0."""
    actual = np.array([veil[y, x] for x, y in pixels], np.float64)
    return float(np.max(np.abs(actual - exact) / exact)), int(np.sum(actual <= 0.0))


def described(values):
    return "" if not values else f"{np.median(values):.0f} [{np.min(values):.0f} .. {np.max(values):.0f}]"


def fog_glow(python, photo, folder, rounds):
    """Blender's node, by fog_glow.py in the Python that has bpy: no veil of ours, but what it is for."""
    source, told = folder / "fog.npy", folder / "fog.json"
    np.save(source, photo.pixels)
    script = Path(__file__).with_name("fog_glow.py")
    subprocess.run([python, script, source, told, "--rounds", str(rounds), "--threads", str(THREADS)], check=True,
                   stdout=subprocess.DEVNULL)
    return json.loads(told.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vglare", default="target/release/vglare", help="the program; target/release/vglare")
    parser.add_argument("--rounds", type=int, default=6, help="turns of each way; 6")
    parser.add_argument("--size", default="1920x1080", help="of the picture; 1920x1080")
    parser.add_argument("--blender-python", help="a Python that has bpy: Blender's Fog Glow is timed, too")
    parser.add_argument("--json", type=Path, help="write all samples to this file")
    args = parser.parse_args()
    cv2.setNumThreads(THREADS)
    os.environ["RAYON_NUM_THREADS"] = str(THREADS)
    version = subprocess.run([args.vglare, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    load = ", ".join(f"{load:.1f}" for load in os.getloadavg())
    print(f"{datetime.date.today()}, {platform.machine()}, {os.cpu_count()} cores, {THREADS} threads each; "
          f"load averages {load}")
    print(f"{version}, numpy {np.__version__}, scipy {scipy.__version__}, OpenCV {cv2.__version__}, "
          f"Python {platform.python_version()}")
    photo = Photo(*map(int, args.size.split("x")))
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        source = folder / "photo.pfm"
        write_pfm(source, photo.pixels)
        pixels = photo.crops()
        exact = photo.veil_at(pixels)
        ours = [Vglare(args.vglare, 1e-2), Vglare(args.vglare, 1e-3)]
        ways = [Scipy(THREADS, np.float32), Scipy(1, np.float32), Scipy(THREADS, np.float64), Dft(), Filter()]
        errors = {way.name: error(way.veil(source, folder), pixels, exact) for way in ours}
        for way in ways:  # and the first, slow calls
            way.prepare(photo)
            errors[way.name] = error(way.convolve(photo.pixels), pixels, exact)
        samples = {way.name: [] for way in [*ours, *ways]}
        for turn in range(args.rounds):
            for way in [*ours, *ways] if turn % 2 == 0 else [*ways[::-1], *ours[::-1]]:
                run = way.run(source, folder) if way in ours else whole_run(way, photo, source, folder)
                samples[way.name].append(run)
        print(f"\nCIE 146 on a plane, every pixel a source, {photo.width} x {photo.height}, 3 colours; ms: median "
              "[least .. most]")
        print("| way | plan or kernel | veil | its check | whole run | processor time | vglare's veil takes, for 1 of "
              "this: medians, least | error |\n|---|---|---|---|---|---|---|---|")
        base = [run["veil"] for run in samples[ours[0].name]]
        for way in [*ours, *ways]:
            runs = samples[way.name]
            of = lambda step: [run[step] for run in runs if step in run]
            veils = of("veil")
            ratio = f"{np.median(base) / np.median(veils):.2f}, {min(base) / min(veils):.2f}"
            worst, dark = errors[way.name]
            note = f"; {dark} of {3 * len(pixels)} values not above 0" if dark else ""
            print(f"| {way.name} | {described(of('plan'))} | {described(veils)} | {described(of('check'))} "
                  f"| {described(of('whole'))} | {described(of('busy'))} | {ratio} | {worst:.1e}{note} |")
        predicted = ", ".join(f"{way.predicted:.1e}" for way in ours)
        print(f"Errors at {len(pixels)} pixels against the sum in 64 bits, relative to the veil at each; "
              f"vglare predicted {predicted}.")
        if args.blender_python:
            told = fog_glow(args.blender_python, photo, folder, max(2, args.rounds // 2))
            samples["Blender"] = told
            for name, runs in told["node_ms"].items():
                print(f"Blender {told['version']}, {name}: {described(runs)} ms; vglare's veil takes "
                      f"{np.median(base) / np.median(runs):.3f} for 1 of this by medians, "
                      f"{min(base) / min(runs):.3f} by the least")
    if args.json:
        args.json.write_text(json.dumps({"samples": samples, "errors": errors}, indent=1))


SCATTERED = scattered()

if __name__ == "__main__":
    main()
