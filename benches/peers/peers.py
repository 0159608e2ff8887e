"""The field of many Gaussians of one size, by vglare and by what else could do it; README.md says how to run it."""

import os

THREADS = 2
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = str(THREADS)

import argparse
import datetime
import json
import math
import platform
import re
import subprocess
import tempfile
import time
from pathlib import Path

import finufft
import numpy as np
import scipy
import scipy.fft

TOLERANCE = 1e-3
SIGMA = 0.05  # of the picture's width


class Scene:
    """The ghosts of `vglare bench --gaussians`, in pixels from the middle of the top left one; y runs downwards."""

    def __init__(self, count, width, height):
        self.count, self.width, self.height = count, width, height
        k = np.arange(count, dtype=np.float64)
        part = lambda irrational: np.modf(0.5 + k * irrational)[0]
        self.x = width * part(0.754877666) - 0.5
        self.y = height * (1.0 - part(0.569840291)) - 0.5
        self.colours = np.stack([part(0.414213562), part(0.732050808), part(0.236067977)])
        self.sigma = SIGMA * width

    def exact(self, columns, rows):
        """The sum at some pixels, in 64 bits."""
        values = np.empty((3, len(columns)))
        for index, (i, j) in enumerate(zip(columns, rows)):
            bells = np.exp(-((self.x - i) ** 2 + (self.y - j) ** 2) / (2 * self.sigma**2))
            values[:, index] = self.colours @ bells
        return values


def padded(length, sigma):
    """A period beyond which copies are below the tolerance, and that a fast transform likes."""
    reach = math.sqrt(2 * math.log(10 / TOLERANCE)) * sigma
    return scipy.fft.next_fast_len(int(math.ceil(length + reach)), real=True)


def degree(period, sigma):
    """The highest harmonic above a tenth of the tolerance."""
    return int(math.ceil(math.sqrt(math.log(10 / TOLERANCE)) * period / (math.sqrt(2) * math.pi * sigma)))


def transfer(orders, period, sigma):
    """The Gaussian's Fourier coefficients, one axis."""
    scale = math.sqrt(2 * math.pi) * sigma / period
    return (scale * np.exp(-2 * (math.pi * orders * sigma / period) ** 2)).astype(np.float32)


class Finufft:
    """Type 1 onto the modes, then an inverse transform that is as large as the period."""

    name = "FINUFFT type 1, inverse FFT"

    def __init__(self, scene):
        self.scene = scene
        self.period = [padded(scene.height, scene.sigma), padded(scene.width, scene.sigma)]
        self.degree = [degree(period, scene.sigma) for period in self.period]
        turns = [2 * math.pi * place / period for place, period in zip((scene.y, scene.x), self.period)]
        self.turns = [np.mod(turn + math.pi, 2 * math.pi).astype(np.float32) - np.float32(math.pi) for turn in turns]
        self.weights = scene.colours.astype(np.complex64)
        orders = [np.arange(-n, n + 1) for n in self.degree]
        self.gain = np.multiply.outer(*[transfer(o, t, scene.sigma) for o, t in zip(orders, self.period)])

    def spectrum(self):
        modes = tuple(2 * n + 1 for n in self.degree)
        return self.gain * finufft.nufft2d1(
            *self.turns, self.weights, modes, eps=TOLERANCE / 10, isign=-1, nthreads=THREADS
        )

    def field(self, spectrum):
        (m, n), (rows, columns) = self.degree, self.period
        half = np.zeros((3, rows, columns // 2 + 1), np.complex64)
        half[:, : m + 1, : n + 1] = spectrum[:, m:, n:]
        half[:, -m:, : n + 1] = spectrum[:, :m, n:]
        whole = scipy.fft.irfft2(half, s=self.period, workers=THREADS, norm="forward", overwrite_x=True)
        return whole[:, : self.scene.height, : self.scene.width]


class Convolution:
    """Splats onto the four nearest pixels, and convolves by a padded transform. The splats are its spectrum."""

    name = "convolution by padded FFT"

    def __init__(self, scene):
        self.scene = scene
        # Splats of ghosts at the border need a pixel beyond it: the period has room for it.
        self.period = [padded(scene.height, scene.sigma), padded(scene.width, scene.sigma)]
        rows, columns = self.period
        across = transfer(np.fft.rfftfreq(columns, 1 / columns), columns, scene.sigma)
        down = transfer(np.fft.fftfreq(rows, 1 / rows), rows, scene.sigma)
        self.gain = np.multiply.outer(down, across) * np.float32(rows * columns)

    def spectrum(self):
        (rows, columns), scene = self.period, self.scene
        picture = np.zeros((3, rows * columns), np.float32)
        left, top = np.floor(scene.x).astype(int), np.floor(scene.y).astype(int)
        across, down = scene.x - left, scene.y - top
        for i, along_x in ((0, 1 - across), (1, across)):
            for j, along_y in ((0, 1 - down), (1, down)):
                index = ((top + j) % rows) * columns + (left + i) % columns
                for colour in range(3):
                    weights = scene.colours[colour] * along_x * along_y
                    picture[colour] += np.bincount(index, weights, rows * columns).astype(np.float32)
        return picture.reshape(3, rows, columns)

    def field(self, picture):
        modes = scipy.fft.rfft2(picture, workers=THREADS)
        modes *= self.gain
        whole = scipy.fft.irfft2(modes, s=self.period, workers=THREADS, overwrite_x=True)
        return whole[:, : self.scene.height, : self.scene.width]


class Split:
    """The series of a degree by rows and columns: matrix products, for the spectrum as for the field."""

    def __init__(self, scene, harmonics):
        self.scene, self.name = scene, f"rows and columns by BLAS, N = {harmonics}"
        period = [padded(scene.height, scene.sigma), padded(scene.width, scene.sigma)]
        orders = np.arange(harmonics + 1)
        self.turns = [np.multiply.outer(orders, 2 * math.pi * z / t) for z, t in zip((scene.y, scene.x), period)]
        doubled = np.where(orders > 0, 2, 1).astype(np.float32)
        self.gain = [np.tile(doubled * transfer(orders, t, scene.sigma), 2) for t in period]
        pixels = [np.multiply.outer(2 * math.pi * np.arange(z) / t, orders) for z, t in
                  zip((scene.height, scene.width), period)]
        self.basis = [np.concatenate([np.cos(p), np.sin(p)], axis=1).astype(np.float32) for p in pixels]

    def spectrum(self):
        y, x = [np.concatenate([np.cos(t), np.sin(t)]).astype(np.float32) for t in self.turns]
        y *= self.gain[0][:, None]
        x *= self.gain[1][:, None]
        return np.stack([(y * colour) @ x.T for colour in self.scene.colours.astype(np.float32)])

    def field(self, spectrum):
        y, x = self.basis
        return np.stack([y @ (table @ x.T) for table in spectrum])


class Vglare:
    """`vglare bench --gaussians`: its own medians of a few rounds, for every turn that it has."""

    name = "vglare"

    def __init__(self, program, scene, rounds):
        self.program, self.scene, self.rounds, self.note = program, scene, rounds, ""

    def times(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "bench.json"
            size = f"{self.scene.width}x{self.scene.height}"
            subprocess.run(
                [self.program, "bench", "--gaussians", str(self.scene.count), "--sigma", str(SIGMA), "--size", size,
                 "--tolerance", str(TOLERANCE), "--rounds", str(self.rounds), "--json", str(path)],
                check=True, stdout=subprocess.DEVNULL,
            )
            report = json.loads(path.read_text())
        table = report["tables"][0]
        self.note, self.device = table["note"], report["device"].get("renderer", "")
        rows = {row["what"]: row["wall_ms"] for row in table["rows"]}
        self.copy, self.plan = rows["copy"], rows["plan"]
        return rows["spectrum"], rows["field"]

    def error(self):
        return float(re.search(r"Off by ([0-9.e+-]+),", self.note).group(1))


def milliseconds(work, *args):
    started = time.perf_counter()
    result = work(*args)
    return 1e3 * (time.perf_counter() - started), result


def error(way, scene):
    """At 500 pixels, borders included, the worst colour."""
    chance = np.random.default_rng(1)
    columns = np.concatenate([chance.integers(0, scene.width, 400), np.zeros(50, int), np.full(50, scene.width - 1)])
    rows = np.concatenate([chance.integers(0, scene.height, 400), np.linspace(0, scene.height - 1, 100).astype(int)])
    exact = scene.exact(columns, rows)
    actual = way.field(way.spectrum())[:, rows, columns]
    return float(np.max(np.abs(actual - exact).max(axis=1) / np.abs(exact).max(axis=1)))


def in_turns(ways, rounds):
    """(spectrum, field) of each way, round after round; every other round backwards."""
    samples = {way.name: [] for way in ways}
    for turn in range(rounds):
        for way in ways if turn % 2 == 0 else reversed(ways):
            if isinstance(way, Vglare):
                samples[way.name].append(way.times())
                continue
            spectrum_ms, spectrum = milliseconds(way.spectrum)
            field_ms, _ = milliseconds(way.field, spectrum)
            samples[way.name].append((spectrum_ms, field_ms))
    return samples


def described(values):
    return f"{np.median(values):8.1f} [{np.min(values):.1f} .. {np.max(values):.1f}]"


def compare_fields(program, rounds):
    scene = Scene(1000, 1920, 1080)
    vglare = Vglare(program, scene, 4)
    ways = [vglare, Finufft(scene), Convolution(scene), Split(scene, 15), Split(scene, 32)]
    errors = {way.name: error(way, scene) for way in ways[1:]}  # and the first, slow calls
    samples = in_turns(ways, rounds)
    errors[vglare.name] = vglare.error()
    base = np.median([sum(pair) for pair in samples[vglare.name]])
    print(f"\n1000 Gaussians, sigma {SIGMA} of the width, 1920 x 1080, 3 colours, f32, tolerance {TOLERANCE:g}; ms")
    print("| way | spectrum | field | both | vglare takes, for 1 of this | error |\n|---|---|---|---|---|---|")
    for way in ways:
        spectra, fields = np.array(samples[way.name]).T
        both = spectra + fields
        ratio = base / np.median(both)
        print(f"| {way.name} | {described(spectra)} | {described(fields)} | {described(both)} | {ratio:.2f} "
              f"| {errors[way.name]:.1e} |")
    print(f"vglare on {vglare.device}: {vglare.note} A copy of the picture takes {vglare.copy:.1f} ms, "
          f"the plan {vglare.plan:.1f} ms, which is not in the table.")


def compare_spectra(program, rounds):
    scene = Scene(1_000_000, 1920, 1080)
    vglare, peer = Vglare(program, scene, 2), Finufft(scene)
    peer.spectrum()
    spectra = {"vglare": [], "FINUFFT type 1": []}
    for _ in range(rounds):
        spectra["vglare"].append(vglare.times()[0])
        # The same modes.
        peer.degree = [int(number) for number in re.search(r"N = (\d+), M = (\d+)", vglare.note).groups()][::-1]
        orders = [np.arange(-n, n + 1) for n in peer.degree]
        peer.gain = np.multiply.outer(*[transfer(o, t, scene.sigma) for o, t in zip(orders, peer.period)])
        spectra["FINUFFT type 1"].extend(milliseconds(peer.spectrum)[0] for _ in range(5))
    print("\nThe spectrum alone of 1,000,000 Gaussians, the same modes; ms")
    print("| way | spectrum | vglare takes, for 1 of this |\n|---|---|---|")
    base = np.median(spectra["vglare"])
    for name, values in spectra.items():
        print(f"| {name} | {described(values)} | {base / np.median(values):.1f} |")
    print(f"vglare: {vglare.note} The plan takes {vglare.plan:.0f} ms.")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vglare", default="target/release/vglare", help="the program; target/release/vglare")
    parser.add_argument("--rounds", type=int, default=10, help="turns of each way; 10")
    parser.add_argument("--million-rounds", type=int, default=2, help="turns for a million Gaussians; 0 leaves them out")
    args = parser.parse_args()
    version = subprocess.run([args.vglare, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    print(f"{datetime.date.today()}, {platform.machine()}, {os.cpu_count()} cores, {THREADS} threads each; load averages "
          f"{', '.join(f'{load:.1f}' for load in os.getloadavg())}")
    print(f"{version}, finufft {finufft.__version__}, numpy {np.__version__}, scipy {scipy.__version__}, "
          f"Python {platform.python_version()}")
    compare_fields(args.vglare, args.rounds)
    if args.million_rounds > 0:
        compare_spectra(args.vglare, args.million_rounds)


if __name__ == "__main__":
    main()
