#!/usr/bin/env python3
"""Makes the golden files of ghosts, by optiland's rays, from media/lenses/*.toml.

    python3 -m venv optics-env
    optics-env/bin/pip install optiland==0.6.3
    optics-env/bin/python tests/golden-optics/make.py [NAME ...]

README.md beside this says what is in the files. Takes some minutes.
"""

import json
import math
import pathlib
import sys
import time
import warnings

import numpy as np

warnings.filterwarnings("ignore")

from optiland.materials import IdealMaterial  # noqa: E402
from optiland.optic import Optic  # noqa: E402
from optiland.physical_apertures import RadialAperture  # noqa: E402
from optiland.rays import RealRays  # noqa: E402
from optiland.sequences import SequencedOptic  # noqa: E402

import formats  # noqa: E402
import lens as reader  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
NAMES = ["singlet", "double-gauss", "tessar", "triplet", "retrofocus", "sonnar",
         "telephoto"]
FIELDS = [0.0, 5.0, 10.0, 20.0]
GRID = 64


def optic(lens):
    """Our surfaces as optiland's; surface numbers stay, the sensor is last."""
    o = Optic()
    o.surfaces.add(index=0, radius=np.inf, thickness=np.inf)
    # One object for all air: optiland compares media by identity.
    media = {1.0: "air"}
    for k in range(lens.count):
        n = lens.after[k]
        if n not in media:
            media[n] = IdealMaterial(n=n)
        o.surfaces.add(
            index=k + 1, radius=lens.radius[k], conic=lens.conic[k],
            thickness=lens.thickness[k], material=media[n], is_stop=k == lens.stop,
            aperture=RadialAperture(r_max=lens.semi[k]))
    o.surfaces.add(index=lens.count + 1)
    o.set_aperture("float_by_stop_size", 2 * lens.semi[lens.stop])
    o.fields.set_type("angle")
    o.fields.add(y=0)
    o.fields.add(y=1)
    o.wavelengths.add(value=reader.D_LINE, is_primary=True)
    return o


def scalar(value):
    return float(np.squeeze(value))


def disc():
    """Midpoints of a GRID x GRID net of the unit square that lie in its disc."""
    m = (2 * np.arange(GRID) + 1) / GRID - 1
    x, y = np.meshgrid(m, m)
    inside = x * x + y * y <= 1
    return x[inside], y[inside]


def launch(x, y, z, angle):
    """Parallel light through points (x, y) of the plane z, from before the lens."""
    back = 100.0
    d = np.array([0.0, math.sin(angle), math.cos(angle)])
    one = np.ones_like(x)
    return RealRays(x, y - back * d[1] / d[2], (z - back) * one, 0 * one, d[1] * one,
                    d[2] * one, one, reader.D_LINE * one)


def ghost_steps(a, b, last):
    """The path that b and then a reflect; None: the path of the picture."""
    if a is None:
        return list(range(1, last + 1))
    return (list(range(1, b)) + [(b, "reflect")] + list(range(b - 1, a, -1))
            + [(a, "reflect")] + list(range(a + 1, last + 1)))


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def fresnel(lens, steps, path, start):
    """Share of the power of unpolarised light that follows each ray.

    Our own: optiland takes a reflecting step to lie between a medium and
    itself, so its Fresnel coating reflects nothing there. Two crossed
    polarisations follow the ray as vectors, phases left out but for signs and
    total reflection; their powers are averaged.
    """
    k_in = start
    first = np.cross(k_in, np.tile([0.0, 0.0, 1.0], (len(k_in), 1)))
    short = np.linalg.norm(first, axis=1) < 1e-9
    first[short] = [1.0, 0.0, 0.0]
    first /= np.linalg.norm(first, axis=1)[:, None]
    fields = [first.astype(complex), np.cross(k_in, first).astype(complex)]
    forward = True
    for step, (point, k_out) in zip(steps[:-1], path):
        reflect = isinstance(step, tuple)
        k = (step[0] if reflect else step) - 1
        n1, n2 = lens.before[k], lens.after[k]
        if not forward:
            n1, n2 = n2, n1
        if reflect or n1 != n2:
            if math.isinf(lens.radius[k]):
                normal = np.tile([0.0, 0.0, 1.0], (len(point), 1))
            else:
                normal = (point - [0, 0, lens.z[k] + lens.radius[k]]) / lens.radius[k]
            c1 = np.abs(dot(k_in, normal))
            s2 = (n1 / n2) ** 2 * (1 - c1 * c1)
            c2 = np.sqrt((1 - s2).astype(complex))
            s = np.cross(k_in, normal)
            length = np.linalg.norm(s, axis=1)
            flat = length < 1e-12
            s[flat] = first[flat]
            s -= k_in * dot(s, k_in)[:, None]
            s /= np.linalg.norm(s, axis=1)[:, None]
            p_in, p_out = np.cross(k_in, s), np.cross(k_out, s)
            rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2)
            rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
            if reflect:
                a_s, a_p = rs, rp
            else:
                a_s = np.sqrt(np.maximum(0, 1 - np.abs(rs) ** 2))
                a_p = np.sqrt(np.maximum(0, 1 - np.abs(rp) ** 2))
            fields = [(a_s * dot(e, s))[:, None] * s + (a_p * dot(e, p_in))[:, None] * p_out
                      for e in fields]
        if reflect:
            forward = not forward
        k_in = k_out
    return sum(np.sum(np.abs(e) ** 2, axis=1) for e in fields) / 2


def own_trace(lens, steps, p, d):
    """The same rays by our own tracer, as a check of optiland's: ends and path."""
    p, d = p.copy(), d.copy()
    alive = np.ones(len(p), bool)
    forward = True
    for step in steps[:-1]:
        reflect = isinstance(step, tuple)
        k = (step[0] if reflect else step) - 1
        n1, n2 = lens.before[k], lens.after[k]
        if not forward:
            n1, n2 = n2, n1
        r, z = lens.radius[k], lens.z[k]
        with np.errstate(all="ignore"):
            if math.isinf(r):
                t = (z - p[:, 2]) / d[:, 2]
                p = p + t[:, None] * d
                normal = np.tile([0.0, 0.0, -1.0], (len(p), 1))
            else:
                o = p - [0, 0, z + r]
                b = dot(o, d)
                disc = b * b - dot(o, o) + r * r
                root = np.sqrt(disc)
                # The half of the sphere that holds the vertex.
                t = np.where((r > 0) == (d[:, 2] > 0), -b - root, -b + root)
                p = p + t[:, None] * d
                normal = (p - [0, 0, z + r]) / abs(r)
            alive &= np.hypot(p[:, 0], p[:, 1]) <= lens.semi[k]
            cos = -dot(normal, d)
            normal[cos < 0] *= -1
            cos = np.abs(cos)
            if reflect:
                d = d + 2 * cos[:, None] * normal
                forward = not forward
            else:
                mu = n1 / n2
                rest = 1 - mu * mu * (1 - cos * cos)
                d = mu * d + (mu * cos - np.sqrt(rest))[:, None] * normal
        alive &= np.isfinite(d).all(axis=1)
    with np.errstate(all="ignore"):
        t = (lens.z[-1] - p[:, 2]) / d[:, 2]
        return p + t[:, None] * d, alive & (d[:, 2] > 0)


class Tracer:
    def __init__(self, lens, name):
        self.lens, self.name = lens, name
        self.optic = optic(lens)
        self.last = lens.count + 1
        self.worst = 0.0
        self.strays = self.rays = 0

    def trace(self, a, b, rays):
        steps = ghost_steps(a, b, self.last)
        start = np.stack([rays.L, rays.M, rays.N], axis=1)
        origin = np.stack([rays.x, rays.y, rays.z], axis=1)
        q = SequencedOptic(self.optic, "g", steps)
        q.surfaces.trace(rays)
        views = q.surfaces.surfaces
        end = np.stack([np.ravel(views[-1].x), np.ravel(views[-1].y)], axis=1)
        alive = np.isfinite(end).all(axis=1) & (np.ravel(rays.i) > 0)
        # Light that reaches the sensor goes forward.
        alive &= np.nan_to_num(np.ravel(views[-2].N)) > 0
        mine, lives = own_trace(self.lens, steps, origin, start)
        self.rays += len(alive)
        with np.errstate(invalid="ignore"):
            same = np.abs(end - mine[:, :2]).max(axis=1) < 1e-4
        both = alive & lives & same
        # Nearly along a surface the two choose another meeting point: left out.
        self.strays += int(np.sum((alive | lives) & ~both))
        alive = both
        if both.any():
            self.worst = max(self.worst, float(np.max(np.abs(end[both] - mine[both, :2]))))
        path = [(np.stack([np.ravel(v.x), np.ravel(v.y), np.ravel(v.z)], axis=1)[alive],
                 np.stack([np.ravel(v.L), np.ravel(v.M), np.ravel(v.N)], axis=1)[alive])
                for v in views[:-1]]
        power = fresnel(self.lens, steps, path, start[alive]) if alive.any() else np.zeros(0)
        return end, alive, power

    def near_axis(self, a, b):
        h, angle = 1e-4, 1e-5
        epl = self.epl
        ends = []
        for rays in (launch(np.zeros(1), np.array([h]), 0.0, 0.0),
                     launch(np.zeros(1), np.zeros(1), epl, angle)):
            q = SequencedOptic(self.optic, "g", ghost_steps(a, b, self.last))
            q.surfaces.trace(rays)
            ends.append(scalar(q.surfaces.surfaces[-1].y))
        return ends[0] / h, ends[1] / math.tan(angle)


def matrices(lens, a, b):
    """Our own A and B of a pair, by 2 x 2 matrices, unfolded: [y, n u]."""
    def refract(k, n1, n2, r):
        return np.array([[1, 0], [-(n2 - n1) / r, 1]])

    def move(d, n):
        return np.array([[1, d / n], [0, 1.0]])

    before, after, radius = lens.before, lens.after, lens.radius
    m = np.eye(2)
    for k in range(b):
        m = move(lens.thickness[k], after[k]) @ refract(k, before[k], after[k], radius[k]) @ m
    m = np.array([[1, 0], [2 * before[b] / radius[b], 1]]) @ m
    for k in range(b - 1, a, -1):
        m = refract(k, after[k], before[k], -radius[k]) @ move(lens.thickness[k], after[k]) @ m
    m = move(lens.thickness[a], after[a]) @ m
    m = np.array([[1, 0], [-2 * after[a] / radius[a], 1]]) @ m
    m = move(lens.thickness[a], after[a]) @ m
    for k in range(a + 1, lens.count):
        m = move(lens.thickness[k], after[k]) @ refract(k, before[k], after[k], radius[k]) @ m
    return m


def number(value):
    return 0.0 if abs(value) < 1e-9 else float(f"{value:.7g}")


def make(name):
    began = time.time()
    lens = reader.Lens(reader.LENSES / f"{name}.toml")
    t = Tracer(lens, name)
    paraxial = t.optic.paraxial
    t.epl = scalar(paraxial.EPL())
    epd = scalar(paraxial.EPD())
    own_epl, own_epd = lens.pupil()
    assert abs(t.epl - own_epl) < 1e-6 and abs(epd - own_epd) < 1e-6, (t.epl, own_epl, epd, own_epd)
    assert abs(scalar(paraxial.f2()) - lens.efl) < 1e-6
    widest = lens.data["field"]
    fields = [f for f in FIELDS if f <= widest]
    if len(fields) < 3:
        fields = [0.0, widest / 2, widest]
    x, y = disc()
    # Both samplings at all fields are one bundle.
    parts, rays = [], []
    for f in fields:
        for kind, radius, z in (("pupil", epd / 2, t.epl), ("front", lens.semi[0], 0.0)):
            parts.append((f, kind))
            rays.append(launch(x * radius, y * radius, z, math.radians(f)))

    def bundle():
        return RealRays(*(np.concatenate([getattr(r, key) for r in rays])
                          for key in ("x", "y", "z", "L", "M", "N", "i", "w")))

    def measure(a, b):
        end, alive, power = t.trace(a, b, bundle())
        full = np.zeros(len(alive))
        full[alive] = power
        out = []
        for f in fields:
            entry = {"angle": f}
            for i, (g, kind) in enumerate(parts):
                if g != f:
                    continue
                part = slice(i * len(x), (i + 1) * len(x))
                live = alive[part]
                count = int(live.sum())
                e = end[part][live]
                row = {"rays": count}
                if count:
                    assert abs(e[:, 0].mean()) < 1e-6, "not symmetric"
                    row["y"] = number(e[:, 1].mean())
                    row["rms"] = [number(v) for v in e.std(axis=0)]
                    row["flux"] = number(full[part].sum() / len(x))
                entry[kind] = row
            out.append(entry)
        return out

    pairs = []
    worst = 0.0
    kept = [k for k in range(1, lens.count + 1) if lens.before[k - 1] != lens.after[k - 1]]
    for i, a in enumerate(kept):
        for b in kept[i + 1:]:
            near = t.near_axis(a, b)
            m = matrices(lens, a - 1, b - 1)
            mine = m[0, 0], m[0, 1] - t.epl * m[0, 0]
            for u, v in zip(near, mine):
                worst = max(worst, abs(u - v) / max(abs(v), 1e-2))
            pairs.append({"pair": [a, b], "a": number(near[0]), "b": number(near[1]),
                          "fields": measure(a, b)})
    out = {
        "lens": name, "wavelength": reader.D_LINE,
        "focal_length": number(scalar(paraxial.f2())),
        "back_focus": number(lens.back_focus),
        "sensor": number(lens.z[-1]),
        "entrance_pupil": number(t.epl), "entrance_pupil_diameter": number(epd),
        "f_number": number(scalar(paraxial.FNO())),
        "launched": len(x), "front_radius": lens.semi[0],
        "picture": measure(None, None), "pairs": pairs,
    }
    text = json.dumps(out, separators=(",", ":")).replace('{"pair"', '\n{"pair"').replace(
        '"picture"', '\n"picture"') + "\n"
    (HERE / f"{name}.json").write_text(text)
    print(f"{name}: {len(pairs)} pairs, near the axis within {worst:.1e} of matrices; own rays "
          f"within {t.worst:.1e} mm, {t.strays} of {t.rays} left out; "
          f"{len(text) // 1000} kB, {time.time() - began:.0f} s", flush=True)


def main():
    for name in sys.argv[1:] or NAMES:
        make(name)
    if not sys.argv[1:]:
        formats.write()


if __name__ == "__main__":
    main()
