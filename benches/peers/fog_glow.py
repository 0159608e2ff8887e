"""What Blender's Fog Glow takes for a photo, for veil.py; runs in a Python that has bpy 5, which asks for numpy 1."""

import argparse
import json
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np


def photo_image(pixels, folder):
    """The photo as Blender reads one from a file, all in 32-bit floats."""
    height, width = pixels.shape[:2]
    samples = np.ones((height, width, 4), np.float32)
    samples[..., :3] = pixels[::-1]  # Blender's rows run upwards
    image = bpy.data.images.new("photo", width, height, alpha=False, float_buffer=True)
    image.pixels.foreach_set(samples.ravel())
    image.file_format, image.filepath_raw = "OPEN_EXR", str(Path(folder) / "photo.exr")
    image.save()
    return bpy.data.images.load(image.filepath_raw)


def compositing(image, quality):
    """Nodes that pass the photo on, through a Fog Glow of every pixel where a quality is given."""
    tree = bpy.data.node_groups.new("veil", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    source, output = tree.nodes.new("CompositorNodeImage"), tree.nodes.new("NodeGroupOutput")
    source.image, socket = image, source.outputs["Image"]
    if quality:
        glare = tree.nodes.new("CompositorNodeGlare")
        settings = {"Type": "Fog Glow", "Quality": quality, "Threshold": 0.0, "Size": 1.0}
        for name, value in settings.items():
            glare.inputs[name].default_value = value
        tree.links.new(socket, glare.inputs["Image"])
        socket = glare.outputs["Image"]
    tree.links.new(socket, output.inputs[0])
    return tree


def milliseconds(scene, tree):
    scene.compositing_node_group = tree
    started = time.perf_counter()
    bpy.ops.render.render()
    return 1e3 * (time.perf_counter() - started)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("photo", help="rows of red, green and blue, as .npy")
    parser.add_argument("told", type=Path, help="the JSON file to write")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    args = parser.parse_args()
    pixels = np.load(args.photo)
    scene = bpy.context.scene
    render = scene.render
    render.resolution_y, render.resolution_x = pixels.shape[:2]
    render.resolution_percentage, render.use_compositing = 100, True
    render.threads_mode, render.threads = "FIXED", args.threads
    render.compositor_device, render.compositor_precision = "CPU", "FULL"
    with tempfile.TemporaryDirectory() as folder:
        image = photo_image(pixels, folder)
        trees = {quality: compositing(image, quality) for quality in (None, "High", "Low")}
        for tree in trees.values():
            milliseconds(scene, tree)  # the first, slow calls
        samples = {quality: [] for quality in trees}
        for turn in range(args.rounds):
            for quality in list(trees)[:: 1 if turn % 2 == 0 else -1]:
                samples[quality].append(milliseconds(scene, trees[quality]))
    passed = float(np.median(samples.pop(None)))
    # Less than passing the photo on it cannot take.
    nodes = {f"Fog Glow {quality}": [max(run - passed, 0.0) for run in runs] for quality, runs in samples.items()}
    args.told.write_text(json.dumps({"version": bpy.app.version_string, "pass_through_ms": passed, "node_ms": nodes}))


if __name__ == "__main__":
    main()
