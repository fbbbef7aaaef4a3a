"""Bakes scenes with Blender's Cycles and with gltf-radiosity, and prints a Markdown table of costs and errors.

Started by the script `against_blender`, which installs what this needs. Standard library only.
"""

import argparse
import json
import pathlib
import shlex
import sys
import tempfile

sys.dont_write_bytecode = True

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "test_assets"))

from blender_colors import vertex_count, write_colored, write_for_blender  # noqa: E402
from cornell_box import cornell_box  # noqa: E402
from process import end_children_on_sigterm, run  # noqa: E402

# The scenes unless others are named, by their number of vertices.
CORNELL_BOXES = [1500, 5000]
# The file's own vertices at two qualities, and what one gets without any option.
OUR_OPTIONS = ["--refine none --quality draft", "--refine none", ""]
# Debian's Blender takes its Python from the path, and must not find another one there.
BLENDER = ["env", "PATH=/usr/bin:/bin", "blender", "--background", "--factory-startup", "--python-exit-code", "1"]


class Checker:
    """What says how wrong a bake is: `gltf-radiosity verify`, or a program like it. START HERE if its report changes."""

    def __init__(self, arguments):
        sky = ["--sky", arguments.sky] if arguments.sky else []
        self.options = ["--points", arguments.points, *sky]
        if arguments.checker:
            self.command = [arguments.checker]
            self.options += ["--spp", arguments.spp]
            self.rmse, self.p99 = "rel_rmse", "p99"
        else:
            self.command = [arguments.gltf_radiosity, "verify"]
            self.options += ["--json", "-", "--progress", "none"]
            self.rmse, self.p99 = "relativeRmse", "p99"

    def errors(self, scene, baked):
        """(relative RMSE, 99th percentile of the relative error)."""
        checked = run([*self.command, scene, baked, *self.options])
        if checked.failure:
            sys.exit(f"{self.command[0]}: cannot compare {baked.name} with {scene.name}: {checked.failure}")
        report = json.loads(checked.stdout)
        return report[self.rmse], report[self.p99]


class Row:
    """A bake, done or failed."""

    def __init__(self, tool, how, bake, vertices=0, errors=None):
        self.tool, self.how, self.bake, self.vertices = tool, how, bake, vertices
        self.failure = bake.failure
        self.rmse, self.p99 = errors or (float("inf"), float("inf"))

    def cells(self, comparison):
        if self.failure:
            return [self.tool, self.how, "", f"{self.bake.cpu_s:.2f}", f"{self.bake.wall_s:.2f}", self.failure, "", ""]
        figures = [f"{self.bake.cpu_s:.2f}", f"{self.bake.wall_s:.2f}", f"{100 * self.rmse:.1f} %", f"{100 * self.p99:.0f} %"]
        return [self.tool, self.how, str(self.vertices), *figures, comparison]


def bake_with_blender(scene, samples, exposure, folder, arguments, checker):
    named, light, out = folder / "for_blender.glb", folder / f"light_{samples}", folder / f"blender_{samples}.glb"
    light.mkdir()
    write_for_blender(scene, named)
    command = [*BLENDER, "--python", HERE / "bake_in_blender.py", "--"]
    command += [named, light, samples, arguments.bounces, arguments.sky or "0,0,0"]
    bake = run(command, arguments.time_limit)
    how = f"{samples} samples"
    if bake.failure:
        return Row("Blender", how, bake)
    write_colored(named, light, exposure, out)
    return Row("Blender", how, bake, vertex_count(out), checker.errors(scene, out))


def bake_with_ours(scene, options, folder, arguments, checker):
    """The row, and the exposure that was chosen."""
    out, report_path = folder / "ours.glb", folder / "report.json"
    command = [arguments.gltf_radiosity, scene, out, *shlex.split(options), "--json", report_path, "--progress", "none"]
    if arguments.sky:
        command += ["--sky", arguments.sky]
    bake = run(command, arguments.time_limit)
    how = f"`{options}`" if options else "default"
    if bake.failure:
        return Row("gltf-radiosity", how, bake), 1.0
    report = json.loads(report_path.read_text())
    row = Row("gltf-radiosity", how, bake, report["outputVertices"], checker.errors(scene, out))
    return row, report["exposure"]


def compared(row, ours):
    """How many times the CPU time of the cheapest of our bakes that is at least as right Blender took."""
    as_right = [other for other in ours if not other.failure and other.rmse <= row.rmse]
    if not as_right:
        return "none as right"
    cheapest = min(as_right, key=lambda other: other.bake.cpu_s)
    return f"{row.bake.cpu_s / cheapest.bake.cpu_s:.1f} times that of {cheapest.how}"


def compare(scene, folder, arguments, checker):
    print(f"\n{scene.stem}{', sky ' + arguments.sky if arguments.sky else ''}:\n")
    print("| tool | how | vertices | CPU s | wall s | RMSE | 99 % | Blender's CPU time at equal or lower error |")
    print("|---|---|---|---|---|---|---|---|", flush=True)

    def show(row, comparison=""):
        print("| " + " | ".join(row.cells(comparison)) + " |", flush=True)

    folder.mkdir(parents=True)
    ours, exposures = [], []
    for options in arguments.ours or OUR_OPTIONS:
        row, exposure = bake_with_ours(scene, options, folder, arguments, checker)
        show(row)
        ours.append(row)
        exposures.append(exposure)
    # One exposure for all, since both are clamped at white.
    for samples in arguments.samples:
        row = bake_with_blender(scene, samples, exposures[0], folder, arguments, checker)
        show(row, "" if row.failure else compared(row, ours))


def cornell_boxes(folder):
    """Writes them; answers their paths."""
    paths = [folder / f"cornell_box_{vertices}.glb" for vertices in CORNELL_BOXES]
    for vertices, path in zip(CORNELL_BOXES, paths):
        cornell_box(vertices=vertices).save_glb(path)
    return paths


def parsed_arguments():
    parser = argparse.ArgumentParser(prog="against_blender", description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", type=pathlib.Path, metavar="SCENE.glb", help="default: two Cornell boxes")
    program = ROOT / "build/release/tools/gltf-radiosity"
    parser.add_argument("--gltf-radiosity", type=pathlib.Path, default=program, metavar="PROGRAM")
    parser.add_argument("--sky", metavar="R,G,B", help="luminance of the sky for every tool")
    parser.add_argument("--samples", default="8,64,256,1024", help="samples per corner for Blender (default: %(default)s)")
    parser.add_argument("--bounces", type=int, default=16, help="bounces for Blender (default: %(default)s)")
    parser.add_argument("--ours", action="append", metavar="OPTIONS", help="options of one bake of ours; may be repeated")
    parser.add_argument("--checker", metavar="PROGRAM", help="instead of `gltf-radiosity verify`: IN OUT --points --spp")
    parser.add_argument("--points", type=int, default=4000, help="where errors are measured (default: %(default)s)")
    parser.add_argument("--spp", type=int, default=512, help="for --checker (default: %(default)s)")
    parser.add_argument("--time-limit", type=float, default=600, help="seconds for one bake (default: %(default)s)")
    parser.add_argument("--keep", type=pathlib.Path, metavar="FOLDER", help="keep the baked files in a new folder")
    arguments = parser.parse_args()
    if not arguments.gltf_radiosity.exists():
        parser.error(f"{arguments.gltf_radiosity}: no such program; build it or name it with --gltf-radiosity")
    arguments.samples = [int(count) for count in arguments.samples.split(",")]
    return arguments


def main():
    arguments = parsed_arguments()
    end_children_on_sigterm()
    nothing = run([*BLENDER, "--python-expr", "pass"])
    if nothing.failure:
        sys.exit(f"blender: {nothing.failure}")
    with tempfile.TemporaryDirectory(prefix="against_blender.") as temporary:
        folder = pathlib.Path(temporary)
        for scene in arguments.scenes or cornell_boxes(folder):
            compare(scene, (arguments.keep or folder) / scene.stem, arguments, Checker(arguments))
    print(f"\n{nothing.cpu_s:.2f} s of each of Blender's CPU times go into starting it.")


if __name__ == "__main__":
    main()
