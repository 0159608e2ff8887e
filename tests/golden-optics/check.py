#!/usr/bin/env python3
"""Checks media/lenses/*.toml: numbers against each other and against the patents.

    python3 tests/golden-optics/check.py

Needs Python 3.11 and numpy. Says what is wrong and ends with status 1.
"""

import math
import sys

import numpy as np

import lens as reader

# Back focus that the patents print, scaled as the file is, in millimetres.
PRINTED_BACK_FOCUS = {
    "double-gauss": 35.718,
    "petzval": 56.5 * 0.85,
    "retrofocus": 131.19 * 0.28,
    "telephoto": 0.3883 * 300,
    "planar": 0.70993 * 50,
    "angenieux": 56 * 0.5,
    "heliar": 86.1315,
    "sonnar-180": 74.268,
    "zoom": 42.495,
}

# n_d and V_d as SCHOTT's data sheets print them.
PUBLISHED = {
    "N-BK7": (1.51680, 64.17), "F2": (1.62004, 36.37), "SF2": (1.64769, 33.85),
    "N-SF5": (1.67271, 32.25), "N-SK16": (1.62041, 60.32), "N-LAK9": (1.69100, 54.71),
    "N-F2": (1.62005, 36.43), "SF6": (1.80518, 25.43), "N-SF11": (1.78472, 25.68),
    "N-BAF10": (1.67003, 47.11), "N-SF57": (1.84666, 23.78), "LLF1": (1.54814, 45.75),
    "N-LAK12": (1.67790, 55.20), "N-BAK4": (1.56883, 55.98), "N-FK51A": (1.48656, 84.47),
    "SF1": (1.71736, 29.51), "N-LASF9": (1.85025, 32.17), "K10": (1.50137, 56.41),
    "N-SK2": (1.60738, 56.65), "F5": (1.60342, 38.03), "SF4": (1.75520, 27.58),
    "BK7": (1.51680, 64.17), "N-SK4": (1.61272, 58.63), "SF10": (1.72825, 28.41),
}

failed = False


def wrong(what):
    global failed
    failed = True
    print("WRONG", what)


def check_glasses():
    for name, glass in reader.glasses().items():
        nd, nf, nc = (reader.sellmeier(glass, w)
                      for w in (0.5875618, 0.4861327, 0.6562725))
        abbe = (nd - 1) / (nf - nc)
        if name in PUBLISHED:
            n, v = PUBLISHED[name]
            if abs(nd - n) > 2e-5 or abs(abbe - v) > 0.05:
                wrong(f"glass {name}: {nd:.5f} {abbe:.2f} against {n} {v}")


def check(path, setting):
    lens = reader.Lens(path, setting)
    label = path.stem + (f" {lens.setting['name']}" if lens.setting else "")
    if lens.unknown:
        wrong(f"{label}: unknown keys {lens.unknown}")
    if lens.data["coating"] not in reader.COATINGS:
        wrong(f"{label}: coating {lens.data['coating']}")
    if sum(bool(s.get("stop")) for s in lens.data["surface"]) != 1:
        wrong(f"{label}: not one stop")
    for i, s in enumerate(lens.data["surface"]):
        if s.get("stop") and {"radius", "glass", "index"} & s.keys():
            wrong(f"{label}: surface {i + 1} is more than a stop")
        if "index" in s and not (1.4 < s["index"] < 2.1 and 17 < s["abbe"] < 96):
            wrong(f"{label}: glass of surface {i + 1}")
        if i + 1 < lens.count and not lens.thickness[i] >= 0:
            wrong(f"{label}: thickness {i + 1}")
    if lens.after[-1] != 1:
        wrong(f"{label}: ends in glass")

    epl, epd = lens.pupil()
    number = lens.efl / epd
    if abs(lens.efl / lens.focal_length - 1) > 0.01:
        wrong(f"{label}: focal length {lens.efl:.3f}")
    if abs(number / lens.f_number - 1) > 0.01:
        wrong(f"{label}: f-number {number:.3f}")
    if not lens.back_focus > 0:
        wrong(f"{label}: back focus {lens.back_focus:.3f}")
    printed = PRINTED_BACK_FOCUS.get(path.stem)
    if printed and abs(lens.back_focus / printed - 1) > 0.01:
        wrong(f"{label}: back focus {lens.back_focus:.3f} against {printed:.3f}")

    # Real rays on the axis: the highest that passes every rim.
    low, high = 0.0, epd
    for _ in range(40):
        middle = (low + high) / 2
        if lens.trace(middle, 0.0) is None:
            high = middle
        else:
            low = middle
    real = lens.efl / (2 * low)
    if real > lens.f_number * 1.05:
        wrong(f"{label}: rims leave f/{real:.2f} on the axis")

    # A wrong sign or digit blurs the image of a star on the axis: the rays at
    # the best of some planes lie within 1/2000 of the focal length, r.m.s.
    heights = [lens.trace(y, 0.0) for y in np.linspace(-1, 1, 61) * low]
    ends = np.array([(h[-2], h[-1]) for h in heights if h])
    slope = (ends[:, 1] - ends[:, 0]) / (lens.back_focus)
    blur = min(np.std(ends[:, 1] + slope * d)
               for d in np.linspace(-0.01, 0.01, 201) * lens.efl)
    if blur * 2000 > lens.efl:
        wrong(f"{label}: blur on the axis {blur:.4f} mm")

    # Rims within their spheres, and spaces that stay open at the rim.
    for i in range(lens.count):
        if not lens.semi[i] < abs(lens.radius[i]):
            wrong(f"{label}: rim of surface {i + 1} beyond its sphere")
    for i, edge in enumerate(lens.edges()):
        if edge < (0 if lens.before[i + 1] == 1 else 0.25):
            wrong(f"{label}: {edge:.3f} mm at the rim between {i + 1} and {i + 2}")

    # How much light is left off the axis: share of an even grid over the
    # pupil's height that passes, at the half diagonal of 36 x 24 mm.
    angle = math.atan(math.hypot(18, 12) / lens.focal_length)
    angle = min(angle, math.radians(lens.data["field"]))
    count = 0
    for y in np.linspace(-1.5, 1.5, 301) * epd / 2 - epl * math.tan(angle):
        count += lens.trace(y, angle) is not None
    on_axis = sum(lens.trace(y, 0.0) is not None
                  for y in np.linspace(-1.5, 1.5, 301) * epd / 2)
    print(f"{label:22} f {lens.efl:8.3f} ({lens.efl / lens.focal_length - 1:+.2%}) "
          f"f/{number:.3f} ({number / lens.f_number - 1:+.2%}) real f/{real:.3f} "
          f"blur {1000 * blur:4.1f} um back focus {lens.back_focus:7.3f} pupil {epl:7.2f} {epd:6.2f} "
          f"at {math.degrees(angle):4.1f} deg {count / on_axis:4.0%} of the height")


def main():
    check_glasses()
    for path in reader.every():
        lens = reader.Lens(path)
        for setting in range(len(lens.settings)) if lens.settings else [None]:
            check(path, setting)
    return failed


if __name__ == "__main__":
    sys.exit(main())
