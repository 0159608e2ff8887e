"""Reads media/lenses/*.toml and does first-order and meridional optics on them.

Used by check.py and make.py; needs Python 3.11 and numpy, nothing of vglare.
Surfaces are numbered from 1, the stop counted. Lengths are in millimetres, the
axis is z and light enters along +z. A radius is positive where its centre lies
towards the sensor.
"""

import math
import pathlib
import tomllib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
LENSES = ROOT / "media" / "lenses"
D_LINE = 0.5875618  # micrometres

KEYS = {"name", "description", "patent", "focal_length", "f_number", "field",
        "coating", "blades", "rotation", "surface", "setting"}
SURFACE_KEYS = {"radius", "thickness", "glass", "index", "abbe", "semi_aperture",
                "conic", "coating", "stop"}
SETTING_KEYS = {"name", "focal_length", "f_number", "thickness"}
COATINGS = {"none", "mgf2", "v", "w", "multi"}


def glasses():
    with open(LENSES / "glass.toml", "rb") as f:
        return {g["name"]: g for g in tomllib.load(f)["glass"]}


def sellmeier(glass, wavelength):
    square = wavelength * wavelength
    return math.sqrt(1 + sum(b * square / (square - c)
                             for b, c in zip(glass["b"], glass["c"])))


class Lens:
    """A prescription, at one of its settings."""

    def __init__(self, path, setting=None):
        self.path = pathlib.Path(path)
        with open(self.path, "rb") as f:
            self.data = tomllib.load(f)
        data = self.data
        self.unknown = sorted(
            (data.keys() - KEYS)
            | {k for s in data["surface"] for k in s.keys() - SURFACE_KEYS}
            | {k for s in data.get("setting", []) for k in s.keys() - SETTING_KEYS})
        self.settings = data.get("setting", [])
        self.focal_length = data["focal_length"]
        self.f_number = data["f_number"]
        self.setting = None
        surfaces = data["surface"]
        count = len(surfaces)
        self.thickness = [s.get("thickness") for s in surfaces]
        if setting is not None:
            self.setting = self.settings[setting]
            self.focal_length = self.setting["focal_length"]
            self.f_number = self.setting["f_number"]
            for key, value in self.setting["thickness"].items():
                self.thickness[int(key) - 1] = value
        self.radius = [s.get("radius", math.inf) for s in surfaces]
        self.conic = [s.get("conic", 0.0) for s in surfaces]
        self.semi = [s["semi_aperture"] for s in surfaces]
        table = None
        self.after = []
        for s in surfaces:
            if "glass" in s:
                table = table or glasses()
                self.after.append(sellmeier(table[s["glass"]], D_LINE))
            else:
                self.after.append(s.get("index", 1.0))
        self.before = [1.0] + self.after[:-1]
        self.stop = next(i for i, s in enumerate(surfaces) if s.get("stop"))
        self.count = count
        self.back_focus = self._back_focus()
        if self.thickness[-1] is None:
            self.thickness[-1] = self.back_focus
        self.z = np.concatenate([[0.0], np.cumsum(self.thickness)])  # last: sensor

    def _system(self, first, last):
        """[y, n u] from just before surface first to just after surface last."""
        m = np.eye(2)
        for k in range(first, last + 1):
            if k > first:
                m = np.array([[1, self.thickness[k - 1] / self.before[k]], [0, 1]]) @ m
            power = (self.after[k] - self.before[k]) / self.radius[k]
            m = np.array([[1, 0], [-power, 1]]) @ m
        return m

    def _back_focus(self):
        m = self._system(0, self.count - 1)
        self.efl = -1 / m[1, 0]
        return -m[0, 0] / m[1, 0]

    def pupil(self):
        """Entrance pupil: distance behind the first vertex, and diameter."""
        if self.stop == 0:
            return 0.0, 2 * self.semi[0]
        m = self._system(0, self.stop - 1)
        m = np.array([[1, self.thickness[self.stop - 1] / self.before[self.stop]],
                      [0, 1]]) @ m
        # y at the stop = m00 y + m01 u: the pupil's centre is where this is 0.
        return m[0, 1] / m[0, 0], 2 * self.semi[self.stop] / abs(m[0, 0])

    def sag(self, k, y):
        r = self.radius[k]
        if math.isinf(r):
            return 0.0 * y
        c = 1 / r
        return c * y * y / (1 + np.sqrt(1 - (1 + self.conic[k]) * c * c * y * y))

    def trace(self, y, angle, clip=True):
        """A meridional ray through (0, y) at z = 0 with slope tan(angle).

        Returns its heights at every surface and the sensor, or None if it
        misses a surface, is totally reflected or (clip) meets a rim.
        """
        p = np.array([0.0, y])  # z, y
        d = np.array([math.cos(angle), math.sin(angle)])
        heights = []
        for k in range(self.count):
            r, z = self.radius[k], self.z[k]
            if math.isinf(r):
                t = (z - p[0]) / d[0]
                q = p + t * d
                normal = np.array([-1.0, 0.0])
            else:
                if self.conic[k]:
                    raise NotImplementedError("conics")
                centre = np.array([z + r, 0.0])
                o = p - centre
                b = o @ d
                disc = b * b - (o @ o - r * r)
                if disc < 0:
                    return None
                root = math.sqrt(disc)
                t = -b - root if r > 0 else -b + root
                q = p + t * d
                normal = (q - centre) / abs(r)
                if normal @ d > 0:
                    normal = -normal
            if clip and abs(q[1]) > self.semi[k]:
                return None
            mu = self.before[k] / self.after[k]
            cos = -(normal @ d)
            rest = 1 - mu * mu * (1 - cos * cos)
            if rest < 0:
                return None
            d = mu * d + (mu * cos - math.sqrt(rest)) * normal
            p = q
            heights.append(q[1])
        t = (self.z[-1] - p[0]) / d[0]
        heights.append(p[1] + t * d[1])
        return heights

    def aim(self, angle, target, guess, clip=False):
        """Height at z = 0 of the ray at an angle that meets the stop at target."""
        h = 1e-5
        y = guess
        for _ in range(60):
            a = self.trace(y, angle, clip)
            b = self.trace(y + h, angle, clip)
            if a is None or b is None:
                return None
            error = a[self.stop] - target
            if abs(error) < 1e-9:
                return y
            slope = (b[self.stop] - a[self.stop]) / h
            y -= max(-2.0, min(2.0, error / slope))
        return y if abs(error) < 1e-6 else None

    def edges(self):
        """Thickness at the rim of each space, glass or air, at the smaller
        and at the larger of its two semi-apertures where both reach."""
        out = []
        for k in range(self.count - 1):
            low = min(self.semi[k], self.semi[k + 1])
            out.append(self.thickness[k] + float(self.sag(k + 1, low) - self.sag(k, low)))
        return out


def every(setting=None):
    """(path, settings) of every lens file."""
    for path in sorted(LENSES.glob("*.toml")):
        if path.name != "glass.toml":
            yield path
