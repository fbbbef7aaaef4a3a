// Reads and writes .glb and .gltf for tests: deliberately apart from the product's own code.
import fs from 'node:fs'
import path from 'node:path'

const component_arrays = {
  5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array,
}
const component_counts = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 }
const json_chunk = 0x4e4f534a
const binary_chunk = 0x004e4942

export function bytes_of_uri(uri, folder) {
  const data = /^data:[^,]*;base64,(.*)$/s.exec(uri)
  return data ? Buffer.from(data[1], 'base64') : fs.readFileSync(path.join(folder, decodeURIComponent(uri)))
}

// { json, buffers, folder }; buffers is [json.buffers.length].
export function read_gltf(file) {
  const bytes = fs.readFileSync(file)
  const folder = path.dirname(file)
  if (bytes.toString('latin1', 0, 4) !== 'glTF') {
    const json = JSON.parse(bytes.toString('utf8'))
    // A buffer that only meshopt falls back to has no bytes.
    return { json, buffers: (json.buffers ?? []).map(({ uri }) => (uri ? bytes_of_uri(uri, folder) : undefined)), folder }
  }
  const chunks = {}
  for (let at = 12; at < bytes.length;) {
    const length = bytes.readUInt32LE(at)
    chunks[bytes.readUInt32LE(at + 4)] = bytes.subarray(at + 8, at + 8 + length)
    at += 8 + length
  }
  const json = JSON.parse(chunks[json_chunk].toString('utf8'))
  const buffers = (json.buffers ?? []).map(({ uri }) => (uri ? bytes_of_uri(uri, folder) : chunks[binary_chunk]))
  return { json, buffers, folder }
}

// A GLB from JSON (an object, or text that may be broken on purpose) and its binary chunk.
export function to_glb(json, binary = Buffer.alloc(0)) {
  const pad = (bytes, filler) => Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, filler)])
  const chunk = (kind, bytes) => {
    const head = Buffer.alloc(8)
    head.writeUInt32LE(bytes.length, 0)
    head.writeUInt32LE(kind, 4)
    return Buffer.concat([head, bytes])
  }
  const text = Buffer.from(typeof json === 'string' ? json : JSON.stringify(json))
  const chunks = [chunk(json_chunk, pad(text, ' '))]
  if (binary.length > 0) chunks.push(chunk(binary_chunk, pad(binary, 0)))
  const head = Buffer.alloc(12)
  head.write('glTF', 0, 'latin1')
  head.writeUInt32LE(2, 4)
  head.writeUInt32LE(12 + chunks.reduce((sum, { length }) => sum + length, 0), 8)
  return Buffer.concat([head, ...chunks])
}

// Bytes of a buffer view.
export function view_bytes({ json, buffers }, index) {
  const { buffer, byteOffset = 0, byteLength } = json.bufferViews[index]
  return buffers[buffer].subarray(byteOffset, byteOffset + byteLength)
}

// The encoded bytes of an image, wherever they are.
export function image_bytes(gltf, index) {
  const { uri, bufferView } = gltf.json.images[index]
  return uri === undefined ? view_bytes(gltf, bufferView) : bytes_of_uri(uri, gltf.folder)
}

function to_unit(value, component_type) {
  const largest = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 }[component_type]
  return largest ? Math.max(value / largest, -1) : value
}

function read_components({ json, buffers }, { bufferView, byteOffset = 0, componentType, count, width, normalized }) {
  const view = json.bufferViews[bufferView]
  const values = component_arrays[componentType]
  const size = values.BYTES_PER_ELEMENT
  const stride = view.byteStride ?? width * size
  const first = (view.byteOffset ?? 0) + byteOffset
  const rows = []
  for (let row = 0; row < count; ++row) {
    const start = first + row * stride
    const bytes = Uint8Array.prototype.slice.call(buffers[view.buffer], start, start + width * size)
    const numbers = [...new values(bytes.buffer)]
    rows.push(normalized ? numbers.map((number) => to_unit(number, componentType)) : numbers)
  }
  return rows
}

// Rows of an accessor as arrays of numbers, normalized and sparse values applied.
export function read_accessor(gltf, index) {
  const accessor = gltf.json.accessors[index]
  const width = component_counts[accessor.type]
  const { count, componentType, normalized, sparse } = accessor
  const rows = accessor.bufferView === undefined
    ? Array.from({ length: count }, () => new Array(width).fill(0))
    : read_components(gltf, { ...accessor, width })
  if (sparse) {
    const where = read_components(gltf, { ...sparse.indices, count: sparse.count, width: 1 })
    const what = read_components(gltf, { ...sparse.values, count: sparse.count, componentType, normalized, width })
    where.forEach(([row], k) => { rows[row] = what[k] })
  }
  return rows
}

// Triples of vertex indices of a primitive of triangles, a strip or a fan.
export function triangles_of(gltf, primitive) {
  const vertex_count = gltf.json.accessors[primitive.attributes.POSITION].count
  const indices = primitive.indices === undefined
    ? Array.from({ length: vertex_count }, (_, i) => i)
    : read_accessor(gltf, primitive.indices).map(([i]) => i)
  const triangles = []
  const mode = primitive.mode ?? 4
  for (let i = 0; i + 2 < indices.length; i += mode === 4 ? 3 : 1) {
    if (mode === 6) triangles.push([indices[i + 1], indices[i + 2], indices[0]])
    else if (mode === 5 && i % 2 === 1) triangles.push([indices[i + 1], indices[i], indices[i + 2]])
    else triangles.push([indices[i], indices[i + 1], indices[i + 2]])
  }
  return triangles
}

// Nodes of the default scene (every root if there is none), parents first; where `enters(node)` is false, neither that
// node nor those below.
export function nodes_of_scene({ json }, enters = () => true) {
  const nodes = json.nodes ?? []
  const children = new Set(nodes.flatMap((node) => node.children ?? []))
  const roots = json.scenes?.[json.scene ?? 0]?.nodes ?? [...nodes.keys()].filter((node) => !children.has(node))
  const found = []
  const left = [...roots].reverse()
  while (left.length > 0) {
    const node = left.pop()
    if (!enters(node)) continue
    found.push(node)
    for (const child of [...(nodes[node].children ?? [])].reverse()) left.push(child)
  }
  return found
}

// [node, primitive of its mesh, index of the primitive] of the default scene.
export function primitives_of_scene(gltf) {
  return nodes_of_scene(gltf).flatMap((node) => primitives_of_node(gltf, node))
}

export function primitives_of_node(gltf, node) {
  const { mesh } = gltf.json.nodes[node]
  return mesh === undefined ? [] : gltf.json.meshes[mesh].primitives.map((primitive, k) => [node, primitive, k])
}

// How many copies of its mesh a node shows by EXT_mesh_gpu_instancing; 0 without it.
export function copy_count({ json }, node) {
  const [accessor] = Object.values(json.nodes[node].extensions?.EXT_mesh_gpu_instancing?.attributes ?? {})
  return accessor === undefined ? 0 : json.accessors[accessor].count
}
