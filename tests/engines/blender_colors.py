"""blender --background --python blender_colors.py -- FILE.glb...

Prints what Blender makes of baked files, as JSON: for each file the colours of all corners of all triangles, as Blender's
nodes see them (linear, with the base colour factor), by object, and whether each material is an emission without lights.
"""
import json
import sys

import bpy
import numpy

numpy.bool = bool  # Blender 3.4's importer still says so; numpy 1.24 does not know it any more


def factor_of(material):
    """What the node tree multiplies the colours by: the constant colour of its mix nodes."""
    factor = [1.0, 1.0, 1.0]
    for node in material.node_tree.nodes:
        if node.type in ("MIX", "MIX_RGB"):
            for entry in node.inputs:
                if entry.type == "RGBA" and not entry.is_linked:
                    factor = [a * b for a, b in zip(factor, entry.default_value)]
    return factor


def corners_of(mesh):
    """[position, colour] of each corner of each triangle."""
    colors = mesh.color_attributes.active_color
    factor = factor_of(mesh.materials[0]) if mesh.materials else [1.0, 1.0, 1.0]
    corners = []
    for loop in mesh.loops:
        at = loop.index if colors.domain == "CORNER" else loop.vertex_index
        color = [a * b for a, b in zip(colors.data[at].color, factor)]
        corners.append([list(mesh.vertices[loop.vertex_index].co), color])
    return corners


def read(file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    meshes = [entry for entry in bpy.data.objects if entry.type == "MESH"]
    kinds = {node.type for material in bpy.data.materials if material.node_tree for node in material.node_tree.nodes}
    return {"emission": "EMISSION" in kinds and "BSDF_PRINCIPLED" not in kinds,
            "corners": {entry.name: corners_of(entry.data) for entry in meshes}}


files = sys.argv[sys.argv.index("--") + 1:]
print("COLORS " + json.dumps({file: read(file) for file in files}))
