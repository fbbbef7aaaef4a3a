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

from blender_colors import vertex_count, write_colored, write_for_blender  # noqa: E402
from process import run  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
# The file's own vertices at two qualities, and what one gets without any option.
OUR_OPTIONS = ["--refine none --quality draft", "--refine none", ""]
# Debian's Blender takes its Python from the path, and must not find another one there.
BLENDER = ["env", "PATH=/usr/bin:/bin", "blender", "--background", "--factory-startup", "--python-exit-code", "1"]


class Checker:
    """What says how wrong a bake is: `gltf-radiosity verify`, or a program like it. START HERE if its report changes."""

    def __init__(self, arguments):
        sky = ["--sky", arguments.sky] if arguments.sky else []
        if arguments.checker:
            self.command = [arguments.checker]
            self.options = ["--points", arguments.points, "--spp", arguments.spp, *sky]
            self.rmse, self.p99 = "rel_rmse", "p99"
        else:
            self.command = [arguments.gltf_radiosity, "verify"]
            self.options = ["--json", "-", *sky]
            self.rmse, self.p99 = "relativeRmse", "p99"

    def errors(self, scene, baked):
        """(relative RMSE, 99th percentile of the relative error)."""
        checked = run([*self.command, scene, baked, *self.options])
        if checked.failure:
            raise RuntimeError(f"the checker failed: {checked.failure}")
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
        figures = [f"{self.bake.cpu_s:.2f}", f"{self.bake.wall_s:.2f}", f"{self.rmse:.1%}", f"{self.p99:.0%}"]
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
    """How much more CPU time Blender took than the cheapest of our bakes that is at least as right."""
    as_right = [other for other in ours if not other.failure and other.rmse <= row.rmse]
    if not as_right:
        return "none as right"
    cheapest = min(as_right, key=lambda other: other.bake.cpu_s)
    return f"{row.bake.cpu_s / cheapest.bake.cpu_s:.3g} x {cheapest.how}"


def compare(scene, arguments, checker):
    print(f"\n{scene.stem}{', sky ' + arguments.sky if arguments.sky else ''}:\n")
    print("| tool | how | vertices | CPU s | wall s | RMSE | 99 % | Blender's CPU time at equal or lower error |")
    print("|---|---|---|---|---|---|---|---|", flush=True)

    def show(row, comparison=""):
        print("| " + " | ".join(row.cells(comparison)) + " |", flush=True)

    with tempfile.TemporaryDirectory(prefix="against_blender.") as temporary:
        folder = pathlib.Path(arguments.keep or temporary) / scene.stem
        folder.mkdir(parents=True, exist_ok=False)
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


def parsed_arguments():
    parser = argparse.ArgumentParser(prog="against_blender", description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="+", type=pathlib.Path, metavar="SCENE.glb")
    parser.add_argument("--gltf-radiosity", required=True, metavar="PROGRAM")
    parser.add_argument("--sky", metavar="R,G,B", help="luminance of the sky for every tool")
    parser.add_argument("--samples", default="8,64,256,1024", help="samples per vertex for Blender (default: %(default)s)")
    parser.add_argument("--bounces", type=int, default=16, help="bounces for Blender (default: %(default)s)")
    parser.add_argument("--ours", action="append", metavar="OPTIONS", help="options of one bake of ours; may be repeated")
    parser.add_argument("--checker", metavar="PROGRAM", help="instead of `gltf-radiosity verify`: IN OUT --points --spp")
    parser.add_argument("--points", type=int, default=4000, help="for --checker (default: %(default)s)")
    parser.add_argument("--spp", type=int, default=512, help="for --checker (default: %(default)s)")
    parser.add_argument("--time-limit", type=float, default=600, help="seconds for one bake (default: %(default)s)")
    parser.add_argument("--keep", metavar="FOLDER", help="keep the baked files in a new folder")
    arguments = parser.parse_args()
    arguments.samples = [int(count) for count in arguments.samples.split(",")]
    return arguments


def main():
    arguments = parsed_arguments()
    nothing = run([*BLENDER, "--python-expr", "pass"])
    if nothing.failure:
        sys.exit(f"blender: {nothing.failure}")
    checker = Checker(arguments)
    for scene in arguments.scenes:
        compare(scene, arguments, checker)
    print(f"\n{nothing.cpu_s:.2f} s of each of Blender's CPU times go into starting it.")


if __name__ == "__main__":
    main()
