#!/usr/bin/env python3
"""Holds that `vglare apply --strength 0` loses nothing of a corpus of OpenEXR files, by OpenEXR's own library.

Usage: compare.py VGLARE FOLDER    (FOLDER as exr.py writes it; needs `pip install OpenEXR numpy`)

Each file goes through vglare. Every part, channel, sample, attribute and compression has to come out as it went in, bit by bit; names
that begin with `refused-` have to be refused, with a reason and without an output. Exit code 1 where one does not.
"""

import numbers
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import OpenEXR

# What vglare adds, and what the library's writer says of the file as it is written.
OF_THE_WRITER = {"chunkCount", "type", "version", "vglare.version", "vglare.settings", "vglare.look"}


def described(value):
    """A value as something that can be compared: arrays by their bytes, objects by their public fields."""
    if isinstance(value, numpy.ndarray) and value.dtype == object:
        return value.shape, [described(part) for part in value.ravel()]
    if isinstance(value, numpy.ndarray):
        return str(value.dtype), value.shape, value.tobytes()
    if isinstance(value, dict):
        return {key: described(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [described(part) for part in value]
    if value is None or isinstance(value, (numbers.Number, str, bytes, numpy.generic)) or hasattr(value, "__members__"):
        return repr(value)
    fields = {}
    for name in (name for name in dir(value) if not name.startswith("_")):
        try:
            field = getattr(value, name)
        except TypeError:  # The module's own fault: its text, below, has them.
            continue
        if not callable(field):
            fields[name] = described(field)
    return repr(value) if not fields else (str(value), fields)


def content(path):
    """All that the library reads of a file: for each part its header and its channels."""
    parts = []
    for part in OpenEXR.File(str(path), separate_channels=True).parts:
        header = {key: described(value) for key, value in part.header.items() if key not in OF_THE_WRITER}
        header["type"] = repr(part.header.get("type"))
        # Their order and kind; the samples follow.
        header.pop("channels", None)
        channels = {}
        for name, channel in part.channels.items():
            sampling = channel.xSampling, channel.ySampling, channel.pLinear
            channels[name] = (sampling, described(channel.pixels))
        parts.append((header, channels))
    return parts


def differences(before, after):
    """What is not the same, in words."""
    if len(before) != len(after):
        return [f"{len(before)} parts became {len(after)}"]
    found = []
    for number, ((header, channels), (new_header, new_channels)) in enumerate(zip(before, after)):
        for kind, old, new in (("attribute", header, new_header), ("channel", channels, new_channels)):
            for name in sorted(old.keys() | new.keys()):
                if name not in new:
                    found.append(f"part {number}: {kind} {name} is gone")
                elif name not in old:
                    found.append(f"part {number}: {kind} {name} is new")
                elif old[name] != new[name]:
                    values = f": {old[name]} became {new[name]}" if kind == "attribute" else ""
                    found.append(f"part {number}: {kind} {name} differs{values}"[:300])
    return found


def problems(vglare, path, folder):
    """What went wrong with one file."""
    out = Path(folder) / "out.exr"
    out.unlink(missing_ok=True)
    command = [vglare, "apply", str(path), "-o", str(out), "--strength", "0", "--quiet"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if path.name.startswith("refused-"):
        refused = run.returncode == 1 and path.name in run.stderr and not out.exists()
        return [] if refused else [f"it was not refused: exit code {run.returncode}, {run.stderr.strip()}"]
    if run.returncode != 0:
        return [run.stderr.strip()]
    return differences(content(path), content(out))


def main():
    """Compares them all."""
    vglare, corpus = sys.argv[1], Path(sys.argv[2])
    paths = sorted(corpus.glob("*.exr"))
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            said = problems(vglare, path, folder)
            bad += bool(said)
            for line in said:
                print(f"{path.name}: {line}")
    print(f"{len(paths) - bad} of {len(paths)} files came out as they went in")
    sys.exit(1 if bad or not paths else 0)


if __name__ == "__main__":
    main()
