#!/usr/bin/env python3
"""Writes a corpus of OpenEXR files by OpenEXR's own library, for compare.py.

Usage: exr.py FOLDER    (needs `pip install OpenEXR numpy`; OpenEXR 3.4 or later)

Every file is small, its samples are by chance from a fixed seed, and its name says what it is for.
"""

import struct
import sys
from pathlib import Path

import numpy
import OpenEXR

WIDTH, HEIGHT = 45, 37
CHANCE = numpy.random.default_rng(20261201)
KINDS = {"half": numpy.float16, "float": numpy.float32, "uint": numpy.uint32}


def window(left, top, width, height):
    """A window of OpenEXR: the first pixel and the last."""
    corner = numpy.array([left, top], "i"), numpy.array([left + width - 1, top + height - 1], "i")
    return corner


def plane(kind, width=WIDTH, height=HEIGHT):
    """Smooth light with some lamps and noise, or numbers of objects."""
    if kind == "uint":
        return CHANCE.integers(0, 2**32, (height, width), dtype=numpy.uint32)
    y, x = numpy.mgrid[0:height, 0:width]
    light = 0.2 + 0.1 * numpy.sin(x / 7) * numpy.cos(y / 5) + CHANCE.random((height, width)) / 50
    light[height // 3, width // 4] = 900.0
    light[2 * height // 3, width // 2] = -0.25
    return light.astype(KINDS[kind])


def colours(kind, prefix="", alpha=True, size=(WIDTH, HEIGHT)):
    """R, G, B and A of a layer."""
    channels = {prefix + name: plane(kind, *size) for name in "RGB"}
    if alpha:
        channels[prefix + "A"] = numpy.clip(plane(kind, *size), 0, 1).astype(KINDS[kind])
    return channels


def header(compression=OpenEXR.ZIP_COMPRESSION, **more):
    """A header with windows of its own."""
    return {"compression": compression, "type": OpenEXR.scanlineimage, **more}


def tiles(width, height):
    """One level of tiles."""
    description = OpenEXR.TileDescription()
    description.xSize, description.ySize = width, height
    description.mode, description.roundingMode = OpenEXR.ONE_LEVEL, OpenEXR.ROUND_DOWN
    return description


def attributes():
    """An attribute of each type that the library's Python module writes."""
    return {
        "owner": "somebody",
        "comments": "ä comment, not in ASCII",
        "capDate": "2026:12:01 12:00:00",
        "utcOffset": -3600.0,
        "expTime": 1 / 48,
        "aperture": 2.8,
        "isoSpeed": 800.0,
        "whiteLuminance": 203.0,
        "adoptedNeutral": numpy.array([0.3127, 0.329], "f"),
        "chromaticities": (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767),
        "timeCode": OpenEXR.TimeCode(1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8),
        "keyCode": OpenEXR.KeyCode(1, 2, 3, 4, 5, 4, 64),
        "worldToCamera": numpy.arange(16, dtype="f").reshape(4, 4),
        "ownMatrix3": numpy.arange(9, dtype="f").reshape(3, 3),
        "ownMatrix4d": numpy.arange(16, dtype="d").reshape(4, 4) / 3,
        "ownInt": 1234567,
        "ownFloat": 1 / 3,
        "ownDouble": numpy.array([1 / 3], "d"),
        "ownV2i": numpy.array([-3, 4], "i"),
        "ownV2f": numpy.array([0.5, 0.25], "f"),
        "ownV2d": numpy.array([1 / 3, 1 / 7], "d"),
        "ownV3i": numpy.array([-3, 4, 5], "i"),
        "ownV3f": numpy.array([0.5, 0.25, 0.125], "f"),
        "ownV3d": numpy.array([1 / 3, 1 / 7, 1 / 9], "d"),
        "ownBox": window(-5, 6, 7, 8),
        "ownText": "x" * 300,
        "ownTexts": ["one", "", "three"],
        "ownFloats": [0.5, 0.25, 1e30],
        "anAttributeWhoseNameIsLongerThanThirtyOneLetters": "long",
        "ownOpaque": OpenEXR.OpaqueAttribute(bytes(range(37)), "ofNoKnownType"),
    }


def accepted():
    """The attributes among these that this version of the module can write, tried one by one."""
    taken = {}
    for name, value in attributes().items():
        try:
            OpenEXR.File(header(**{name: value}), colours("half")).write("/dev/null")
            taken[name] = value
        except (TypeError, ValueError, RuntimeError) as reason:
            print(f"without {name}: {reason}", file=sys.stderr)
    return taken


def raw(path):
    """Puts attributes of types that the module does not write into the header of a file of one part, by their bytes."""
    preview = struct.pack("<II", 2, 1) + bytes([1, 2, 3, 255, 4, 5, 6, 255])
    values = (
        ("framesPerSecond", "rational", struct.pack("<iI", 24000, 1001)),
        ("ownBox2f", "box2f", struct.pack("<4f", -0.5, 0.25, 1.5, 2.0)),
        ("ownBytes", "bytes", struct.pack("<I", 4) + b"hint" + bytes(range(11))),
        ("preview", "preview", preview),
        ("envmap", "envmap", b"\0"),
    )
    added = b"".join(
        name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value for name, kind, value in values
    )
    old = path.read_bytes()
    # ZIP has 16 lines in a block. The table of where blocks are follows the header, and the first of them follows the table.
    chunks = -(-HEIGHT // 16)
    table = next(at for at in range(8, len(old)) if struct.unpack_from("<Q", old, at)[0] == at + 8 * chunks)
    offsets = [offset + len(added) for offset in struct.unpack_from(f"<{chunks}Q", old, table)]
    new = old[:8] + added + old[8:table] + struct.pack(f"<{chunks}Q", *offsets) + old[table + 8 * chunks :]
    path.write_bytes(new)


def deep():
    """A different number of samples in each pixel, in some none."""
    samples = numpy.empty((HEIGHT, WIDTH), dtype=object)
    for y in range(HEIGHT):
        for x in range(WIDTH):
            samples[y, x] = CHANCE.random((x + y) % 4).astype(numpy.float32)
    return samples


def files():
    """Names and files."""
    compressions = [name for name in dir(OpenEXR) if name.endswith("_COMPRESSION")]
    refused = ("HTJ2K", "LJ2K", "ZSTD")
    for name in compressions:
        short = name.removesuffix("_COMPRESSION").lower()
        mark = "refused-" if name.startswith(refused) else ""
        for kind in ("half", "float"):
            channels = {**colours(kind), "Z": plane("float"), "id": plane("uint"), "diffuse.R": plane(kind)}
            yield f"{mark}compression-{short}-{kind}", OpenEXR.File(header(getattr(OpenEXR, name)), channels)
            if not mark:
                tiled = {**header(getattr(OpenEXR, name)), "type": OpenEXR.tiledimage, "tiles": tiles(16, 8)}
                yield f"tiles-{short}-{kind}", OpenEXR.File(tiled, channels)
    for level in (10.0, 200.0):
        level_of = {"dwaCompressionLevel": level}
        yield f"dwaa-level-{level:.0f}", OpenEXR.File(header(OpenEXR.DWAA_COMPRESSION, **level_of), colours("half"))

    yield "uint-colours", OpenEXR.File(header(), {name: plane("uint") for name in "RGB"})
    mixed = {"R": plane("half"), "G": plane("float"), "B": plane("half"), "A": plane("float")}
    yield "mixed-kinds", OpenEXR.File(header(), mixed)
    yield "grey", OpenEXR.File(header(), {"Y": plane("half")})
    for name, order in (("decreasing", OpenEXR.DECREASING_Y), ("increasing", OpenEXR.INCREASING_Y)):
        yield f"lines-{name}", OpenEXR.File(header(lineOrder=order), colours("half"))
    beyond = {"dataWindow": window(-9, 4, WIDTH, HEIGHT), "displayWindow": window(0, 0, 30, 50)}
    yield "windows-apart", OpenEXR.File(header(**beyond), colours("half"))
    within = {"dataWindow": window(107, 211, WIDTH, HEIGHT), "displayWindow": window(100, 200, 60, 60)}
    yield "windows-within", OpenEXR.File(header(pixelAspectRatio=2.0, **within), colours("float"))
    yield "attributes", OpenEXR.File(header(**accepted()), colours("half"))
    for space in ("lin_ap1_scene", "lin_rec2020_scene", "unknown", "srgb_rec709_scene"):
        yield f"interop-{space}", OpenEXR.File(header(colorInteropID=space), colours("half"))

    layers = {**colours("half"), **colours("half", "key."), **colours("float", "fill.", False), "depth.Z": plane("float")}
    yield "layers", OpenEXR.File(header(OpenEXR.PIZ_COMPRESSION), layers)
    nested = {**colours("half", "view.Combined."), **colours("half", "view.Mist.", False), "view.Normal.X": plane("half")}
    yield "layers-nested", OpenEXR.File(header(), nested)

    def part(name, channels, **more):
        return OpenEXR.Part(header(**more), channels, name)

    depth = {"Z": plane("float", 20, 10)}
    place = {"dataWindow": window(3, 5, 20, 10), "displayWindow": window(0, 0, WIDTH, HEIGHT)}
    display = {"displayWindow": window(0, 0, WIDTH, HEIGHT)}
    yield "parts", OpenEXR.File([
        part("depth", depth, **place),
        part("rgba", colours("half"), compression=OpenEXR.DWAB_COMPRESSION, ownText="of rgba", **display),
        part("ids", {"id": plane("uint")}, compression=OpenEXR.ZIPS_COMPRESSION, **display),
        part("lossy", colours("half", "spec."), compression=OpenEXR.B44A_COMPRESSION, **display),
    ])
    yield "parts-tiled", OpenEXR.File([
        part("beauty", colours("float"), type=OpenEXR.tiledimage, tiles=tiles(32, 32), **display),
        part("albedo", colours("half"), compression=OpenEXR.PXR24_COMPRESSION, **display),
    ])
    yield "parts-data", OpenEXR.File([
        part("normals", colours("half", alpha=False), colorInteropID="data", **display),
        part("picture", colours("half"), colorInteropID="lin_ap1_scene", **display),
    ])
    for name in ("NO", "RLE", "ZIPS"):
        fog = part("fog", {"Z": deep()}, type=OpenEXR.deepscanline, compression=getattr(OpenEXR, f"{name}_COMPRESSION"), **display)
        yield f"parts-deep-{name.lower()}", OpenEXR.File([fog, part("rgba", colours("half"), **display)])
    yield "refused-deep", OpenEXR.File(header(OpenEXR.ZIPS_COMPRESSION) | {"type": OpenEXR.deepscanline}, {"Z": deep()})
    yield "stereo", OpenEXR.File([
        part("left", colours("half"), view="left", **display),
        part("right", colours("half"), view="right", **display),
    ])

    even = (48, 36)
    for name in ("ZIP", "ZIPS", "RLE", "NO", "PIZ", "PXR24", "B44", "DWAA"):
        for step in ((2, 2), (4, 2), (2, 1)):
            # The module takes what it writes from planes of full size.
            chroma = {c: OpenEXR.Channel(plane("half", *even), *step) for c in ("RY", "BY")}
            channels = {"Y": plane("half", *even), **chroma}
            mark = "refused-" if name in ("PXR24", "DWAA") and step == (4, 2) else ""
            short = f"{mark}chroma-{name.lower()}-{step[0]}x{step[1]}"
            yield short, OpenEXR.File(header(getattr(OpenEXR, f"{name}_COMPRESSION")), channels)


def main():
    """Writes them all."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    count = 0
    for name, file in files():
        try:
            file.write(str(folder / f"{name}.exr"))
            if name == "attributes":
                raw(folder / f"{name}.exr")
            count += 1
        except (TypeError, ValueError, RuntimeError) as reason:
            print(f"not written: {name}: {reason}", file=sys.stderr)
    print(f"{count} files in {folder}")


if __name__ == "__main__":
    main()
