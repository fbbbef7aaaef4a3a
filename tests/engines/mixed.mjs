// The light of groups, mixed as the numbers of a file say.
import { read_accessor } from '../end_to_end/gltf_file.mjs'

// The index of a new accessor of RGBA floats.
function add_colors({ json, buffers }, rows) {
  const bytes = Buffer.from(Float32Array.from(rows.flat()).buffer)
  buffers.push(bytes)
  json.buffers.push({ byteLength: bytes.length })
  json.bufferViews.push({ buffer: buffers.length - 1, byteLength: bytes.length })
  json.accessors.push({ bufferView: json.bufferViews.length - 1, componentType: 5126, count: rows.length, type: 'VEC4' })
  return json.accessors.length - 1
}

// The same glTF with one COLOR_0 for all light: the sum over groups of their colours x dimmers[name], [r, g, b]; ones where a group
// is not named.
export function mixed(gltf, dimmers = {}) {
  const { groups } = gltf.json.asset.extras.radiosity.lightGroups
  for (const { primitives, extras } of gltf.json.meshes) {
    for (const { attributes, targets } of primitives) {
      if (attributes.COLOR_0 === undefined) continue
      const lights = groups.map(({ target, attribute }) => read_accessor(gltf,
        target === undefined ? attributes[attribute] : targets[extras.targetNames.indexOf(target)].COLOR_0))
      const factors = groups.map(({ name }) => dimmers[name] ?? [1, 1, 1])
      const rows = read_accessor(gltf, attributes.COLOR_0).map((old, v) => [
        ...[0, 1, 2].map((k) => lights.reduce((sum, light, g) => sum + factors[g][k] * light[v][k], 0)), old[3] ?? 1])
      attributes.COLOR_0 = add_colors(gltf, rows)
    }
  }
  return gltf
}
