// Undoes Draco and meshoptimizer with other people's decoders: a compressed file as read_gltf gives a plain one.
import draco3d from 'draco3dgltf'
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js'
import { read_gltf } from './gltf_file.mjs'

const draco_extension = 'KHR_draco_mesh_compression'
const meshopt_extension = 'EXT_meshopt_compression'

const draco = await draco3d.createDecoderModule({})
await MeshoptDecoder.ready

// componentType -> [Draco's type, bytes]
const draco_types = {
  5120: [draco.DT_INT8, 1], 5121: [draco.DT_UINT8, 1], 5122: [draco.DT_INT16, 2], 5123: [draco.DT_UINT16, 2],
  5125: [draco.DT_UINT32, 4], 5126: [draco.DT_FLOAT32, 4],
}
const widths = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }

// Appends bytes as a buffer with one view; answers the number of the view.
function add_view(gltf, bytes) {
  gltf.buffers.push(bytes)
  gltf.json.buffers.push({ byteLength: bytes.length })
  gltf.json.bufferViews.push({ buffer: gltf.buffers.length - 1, byteLength: bytes.length })
  return gltf.json.bufferViews.length - 1
}

function from_heap(size, fill) {
  const pointer = draco._malloc(size)
  fill(pointer)
  const bytes = Buffer.from(draco.HEAPU8.slice(pointer, pointer + size))
  draco._free(pointer)
  return bytes
}

function undo_draco(gltf, primitive) {
  const { [draco_extension]: compressed, ...rest } = primitive.extensions
  const { buffer, byteOffset = 0, byteLength } = gltf.json.bufferViews[compressed.bufferView]
  const bytes = new Int8Array(gltf.buffers[buffer].subarray(byteOffset, byteOffset + byteLength))
  const [decoder, mesh] = [new draco.Decoder(), new draco.Mesh()]
  const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh)
  if (!status.ok()) throw new Error(status.error_msg())

  // Vertices.
  for (const [semantic, id] of Object.entries(compressed.attributes)) {
    const accessor = gltf.json.accessors[primitive.attributes[semantic]]
    if (accessor.count !== mesh.num_points()) throw new Error(`${semantic}: ${mesh.num_points()} vertices, not ${accessor.count}`)
    const [type, component] = draco_types[accessor.componentType]
    const size = mesh.num_points() * widths[accessor.type] * component
    const attribute = decoder.GetAttributeByUniqueId(mesh, id)
    accessor.bufferView = add_view(gltf, from_heap(size, (at) =>
      decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, type, size, at)))
  }

  // Triangles.
  const accessor = gltf.json.accessors[primitive.indices]
  if (accessor.count !== 3 * mesh.num_faces()) throw new Error(`${3 * mesh.num_faces()} indices, not ${accessor.count}`)
  const size = 4 * accessor.count
  accessor.bufferView = add_view(gltf, from_heap(size, (at) => decoder.GetTrianglesUInt32Array(mesh, size, at)))
  accessor.componentType = 5125
  if (Object.keys(rest).length === 0) delete primitive.extensions
  else primitive.extensions = rest
  draco.destroy(mesh)
  draco.destroy(decoder)
}

function undo_meshopt(gltf, view) {
  const { buffer, byteOffset = 0, byteLength, byteStride, count, mode, filter } = view.extensions[meshopt_extension]
  const source = gltf.buffers[buffer].subarray(byteOffset, byteOffset + byteLength)
  const decoded = Buffer.alloc(count * byteStride)
  MeshoptDecoder.decodeGltfBuffer(decoded, count, byteStride, new Uint8Array(source), mode, filter)
  gltf.buffers.push(decoded)
  gltf.json.buffers.push({ byteLength: decoded.length })
  Object.assign(view, { buffer: gltf.buffers.length - 1, byteOffset: 0 })
  delete view.extensions
}

// { json, buffers, folder } with plain accessors, whatever `file` is compressed with.
export function read_compressed(file) {
  const gltf = read_gltf(file)
  for (const view of [...(gltf.json.bufferViews ?? [])]) if (view.extensions?.[meshopt_extension]) undo_meshopt(gltf, view)
  for (const { primitives } of gltf.json.meshes ?? []) {
    for (const primitive of primitives) if (primitive.extensions?.[draco_extension]) undo_draco(gltf, primitive)
  }
  for (const names of ['extensionsUsed', 'extensionsRequired']) {
    const left = gltf.json[names]?.filter((name) => name !== draco_extension && name !== meshopt_extension) ?? []
    if (left.length === 0) delete gltf.json[names]
    else gltf.json[names] = left
  }
  return gltf
}
