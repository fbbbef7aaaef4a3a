"""Bakes a scene into vertex colours with Cycles. Blender runs it; against_blender.py starts it:

    blender --background --factory-startup --python bake_in_blender.py -- IN.glb FOLDER SAMPLES BOUNCES R,G,B

FOLDER/OBJECT.f32 gets H/pi at each vertex of each mesh object: red, green, blue, alpha, 32-bit floats. R,G,B is the
luminance of the sky. The importer calls every object by its node's name, drops vertices that no triangle uses and keeps
the order of all others.

What Blender is given, so that it solves the same problem, and no harder one:

* Diffuse and emitting surfaces only. A principled BSDF has a gloss and is no Lambertian reflector.
* Single-sided surfaces are black from behind; alpha masks cut at their cutoff.
* The surface at the vertex itself counts as white and opaque ("is camera ray"), because light without colour is light
  with colour divided by colour, and a black or transparent texel under a vertex would make a black vertex.
* Point attributes: Cycles samples each corner, and Blender averages the corners that meet at a vertex.
* No clamping of samples; Blender's own choice of threads is all cores.

Debian 12 joins Blender 3.4 with numpy 1.24, which has dropped the alias numpy.bool that the glTF importer needs.
"""

import pathlib
import sys

import bpy
import numpy

numpy.bool = bool

BLACK = (0, 0, 0, 1)
WHITE = (1, 1, 1, 1)


class Nodes:
    """Adds nodes to a tree. An input is given as a number, a colour, or the output of another node."""

    def __init__(self, tree):
        self.tree = tree

    def add(self, kind, inputs, **settings):
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for key, value in inputs.items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def shader(self, kind, inputs):
        return self.add(kind, inputs).outputs[0]

    def mix_shader(self, share, first, second):
        return self.shader("ShaderNodeMixShader", {0: share, 1: first, 2: second})

    def math(self, operation, first, second):
        return self.add("ShaderNodeMath", {0: first, 1: second}, operation=operation).outputs[0]


def source(node, name):
    """What feeds an input: the output linked to it, or its own value."""
    socket = node.inputs[name]
    if socket.is_linked:
        return socket.links[0].from_socket
    value = socket.default_value
    return tuple(value) if hasattr(value, "__len__") else value


def make_diffuse(material):
    """Replaces the principled BSDF that the importer made."""
    nodes = Nodes(material.node_tree)
    principled = next(node for node in nodes.tree.nodes if node.type == "BSDF_PRINCIPLED")
    output = next(node for node in nodes.tree.nodes if node.type == "OUTPUT_MATERIAL")
    at_vertex = nodes.add("ShaderNodeLightPath", {}).outputs["Is Camera Ray"]

    # Reflection, white at the vertex itself.
    color = nodes.add("ShaderNodeMixRGB", {"Fac": at_vertex, "Color1": source(principled, "Base Color"), "Color2": WHITE})
    surface = nodes.shader("ShaderNodeBsdfDiffuse", {"Color": color.outputs[0]})

    # Emission.
    emission = source(principled, "Emission")
    if isinstance(emission, bpy.types.NodeSocket) or any(emission[:3]):
        strength = source(principled, "Emission Strength")
        glow = nodes.shader("ShaderNodeEmission", {"Color": emission, "Strength": strength})
        surface = nodes.shader("ShaderNodeAddShader", {0: surface, 1: glow})

    # Sides.
    if material.use_backface_culling:
        behind = nodes.add("ShaderNodeNewGeometry", {}).outputs["Backfacing"]
        surface = nodes.mix_shader(behind, surface, nodes.shader("ShaderNodeBsdfDiffuse", {"Color": BLACK}))

    # Holes.
    alpha = source(principled, "Alpha")
    if material.blend_method != "OPAQUE":
        if material.blend_method == "CLIP":
            alpha = nodes.math("GREATER_THAN", alpha, material.alpha_threshold - 1e-6)
        alpha = nodes.math("MAXIMUM", alpha, at_vertex)
        surface = nodes.mix_shader(alpha, nodes.shader("ShaderNodeBsdfTransparent", {"Color": WHITE}), surface)

    nodes.tree.links.new(surface, output.inputs["Surface"])
    nodes.tree.nodes.remove(principled)


def set_up(samples, bounces, sky):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.threads_mode = "AUTO"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.seed = 0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = bounces
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*sky, 1)
    background.inputs["Strength"].default_value = 1


def bake(objects):
    bpy.ops.object.select_all(action="DESELECT")
    for item in objects:
        item.data.color_attributes.active_color = item.data.color_attributes.new("COLOR_0", "FLOAT_COLOR", "POINT")
        item.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, target="VERTEX_COLORS")


def main():
    path, folder, samples, bounces, sky = sys.argv[sys.argv.index("--") + 1 :]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path, merge_vertices=False)
    for material in bpy.data.materials:
        if material.node_tree:
            make_diffuse(material)
    set_up(int(samples), int(bounces), tuple(map(float, sky.split(","))))
    objects = [item for item in bpy.context.scene.objects if item.type == "MESH"]
    bake(objects)
    for item in objects:
        colors = numpy.empty(4 * len(item.data.vertices), numpy.float32)
        item.data.color_attributes["COLOR_0"].data.foreach_get("color", colors)
        colors.tofile(pathlib.Path(folder) / f"{item.name}.f32")


main()
