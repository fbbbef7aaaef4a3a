# godot3-server --path PROJECT -s godot_colors.gd
#
# Prints what Godot 3 makes of the baked files in PROJECT, as JSON: for each file a line of numbers for each corner of each
# triangle: x y z, red green blue of the vertex (linear), red green blue of the albedo (sRGB).
extends SceneTree

func read(node, corners):
	if node is MeshInstance:
		for surface in range(node.mesh.get_surface_count()):
			var arrays = node.mesh.surface_get_arrays(surface)
			var albedo = node.mesh.surface_get_material(surface).albedo_color
			for vertex in arrays[Mesh.ARRAY_INDEX]:
				var place = arrays[Mesh.ARRAY_VERTEX][vertex]
				var color = arrays[Mesh.ARRAY_COLOR][vertex]
				corners.append([place.x, place.y, place.z, color.r, color.g, color.b, albedo.r, albedo.g, albedo.b])
	for child in node.get_children():
		read(child, corners)

func _init():
	var found = {}
	var folder = Directory.new()
	folder.open("res://")
	folder.list_dir_begin(true)
	var file = folder.get_next()
	while file != "":
		if file.ends_with(".glb"):
			found[file] = []
			read(load("res://" + file).instance(), found[file])
		file = folder.get_next()
	print("COLORS " + to_json(found))
	quit()
