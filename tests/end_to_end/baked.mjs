// What must hold for every baked file, whatever the scene.
import assert from 'node:assert/strict'
import { image_bytes, primitives_of_scene, read_accessor, read_gltf } from './gltf_file.mjs'
import { new_errors } from './validator.mjs'

const unlit = 'KHR_materials_unlit'
const draco = 'KHR_draco_mesh_compression'
const meshopt = 'EXT_meshopt_compression'
// A shading extension has no effect on an unlit material; nor has anything else that bends, coats or scatters light.
const is_shading = (name) => /^KHR_materials_(?!unlit|variants)/.test(name)

export const material_of = ({ json }, primitive) => json.materials?.[primitive.material] ?? {}
export const is_unlit = (material) => material.extensions?.[unlit] !== undefined
export const has_triangles = ({ mode = 4 }) => mode >= 4

// COLOR_0 of a primitive, as rows of numbers.
export const colors_of = (gltf, primitive) => read_accessor(gltf, primitive.attributes.COLOR_0)

// Whether COLOR_0 must have been written: triangles with vertices and a material that shows light.
function receives(gltf, primitive) {
  const position = gltf.json.accessors?.[primitive.attributes.POSITION]
  return has_triangles(primitive) && position !== undefined && !is_unlit(material_of(gltf, primitive))
}

function check_colors(gltf, primitive, place) {
  assert.notEqual(primitive.attributes.COLOR_0, undefined, `${place} has no COLOR_0`)
  const accessor = gltf.json.accessors[primitive.attributes.COLOR_0]
  assert.equal(accessor.type, 'VEC4', place)
  const { count } = gltf.json.accessors[primitive.attributes.POSITION]
  assert.equal(accessor.count, count, `${place}: one colour per vertex`)
  for (const color of colors_of(gltf, primitive)) {
    for (const band of color) assert.ok(band >= 0 && band <= 1, `${place} has a colour of ${color}`)
  }
}

function check_material(gltf, primitive, source, place) {
  const material = material_of(gltf, primitive)
  assert.ok(is_unlit(material), `${place} is not unlit`)
  const pbr = material.pbrMetallicRoughness ?? {}
  const { baseColorFactor = [1, 1, 1, 1], metallicFactor, roughnessFactor = 1 } = pbr
  assert.deepEqual(baseColorFactor.slice(0, 3), [1, 1, 1], `${place}: the factor belongs into COLOR_0`)
  assert.deepEqual({ metallicFactor, roughnessFactor }, { metallicFactor: 0, roughnessFactor: 1 }, place)
  for (const key of ['emissiveFactor', 'emissiveTexture', 'normalTexture', 'occlusionTexture']) {
    assert.equal(material[key], undefined, `${place} keeps its ${key}`)
  }
  const before = material_of({ json: source.gltf.json }, source.primitive)
  for (const key of ['name', 'alphaMode', 'alphaCutoff', 'doubleSided', 'extras']) {
    assert.deepEqual(material[key], before[key], `${place}: ${key} of the material`)
  }
  assert.deepEqual(pbr.baseColorTexture, before.pbrMetallicRoughness?.baseColorTexture, `${place}: texture`)
  assert.deepEqual(Object.keys(material.extensions).filter(is_shading), [], `${place}: extensions of the material`)
}

// Every primitive of the default scene carries its light, or is what it was.
export function check_primitives(input, output) {
  const before = primitives_of_scene(input)
  const after = primitives_of_scene(output)
  assert.equal(after.length, before.length, 'primitives of the default scene')
  before.forEach(([node, primitive, k], i) => {
    const [node_after, baked] = after[i]
    assert.equal(node_after, node)
    const place = `nodes[${node}] primitive ${k}`
    if (receives(input, primitive)) {
      check_colors(output, baked, place)
      check_material(output, baked, { gltf: input, primitive }, place)
    } else {
      assert.deepEqual(material_of(output, baked), material_of(input, primitive), place)
    }
  })
}

const filtered = (object, keeps) => Object.fromEntries(Object.entries(object).filter(([key]) => keeps(key)))
const pick = (object, ...keys) => filtered(object, (key) => keys.includes(key))
const without = (object, ...keys) => filtered(object, (key) => !keys.includes(key))
const described = (object, ...more) => pick(object, 'name', 'extras', 'extensions', ...more)

function of_primitive(primitive) {
  const extensions = without(primitive.extensions ?? {}, draco, 'KHR_materials_variants')
  return { extras: primitive.extras, extensions, targets: primitive.targets?.length }
}

// A material may become unlit where it stands; what is left of one that something unbaked uses, check_primitives sees.
function of_material(material) {
  const extensions = filtered(material.extensions ?? {}, (name) => name !== unlit && !is_shading(name))
  return { ...pick(material, 'name', 'extras'), extensions }
}

const of_mesh = (mesh) => ({ ...without(mesh, 'primitives'), primitives: mesh.primitives.map(of_primitive) })

// The parts of a file that a bake must not change; `count` limits arrays to which a bake may append.
function kept(json, count) {
  const plain_view = ({ extensions, ...view }) => ({ ...view, extensions: without(extensions ?? {}, meshopt) })
  const first = (array, view) => (json[array] ?? []).slice(0, count[array]?.length ?? 0).map(view)
  const { radiosity, ...asset_extras } = json.asset.extras ?? {}
  const rest = without(json, 'asset', 'extensionsUsed', 'extensionsRequired', 'materials', 'meshes', 'accessors',
    'bufferViews', 'buffers', 'images', 'nodes')
  return {
    ...rest,
    asset: { ...without(json.asset, 'generator', 'extras'), extras: asset_extras },
    nodes: json.nodes?.map((node) => without(node, 'mesh')),
    mesh_of_node: json.nodes?.map(({ mesh }) => (mesh === undefined ? null : of_mesh(json.meshes[mesh]))),
    materials: first('materials', of_material),
    meshes: first('meshes', of_mesh),
    accessors: first('accessors', (accessor) => described(accessor, 'componentType', 'type')),
    buffer_views: first('bufferViews', (view) => described(plain_view(view), 'byteStride', 'target')),
    images: first('images', (image) => described(image)),
  }
}

// Everything a bake does not understand is where it was.
export function check_nothing_is_lost(input, output) {
  assert.deepEqual(kept(output.json, input.json), kept(input.json, input.json))
  const used = new Set(output.json.extensionsUsed ?? [])
  for (const name of input.json.extensionsUsed ?? []) {
    assert.ok(used.has(name) || [draco, meshopt].includes(name) || is_shading(name), `extensionsUsed lost ${name}`)
  }
  for (const [index] of (input.json.images ?? []).entries()) {
    assert.ok(image_bytes(input, index).equals(image_bytes(output, index)), `images[${index}] changed`)
  }
  const requires_unlit = ({ json }) => json.extensionsRequired?.includes(unlit) ?? false
  assert.equal(requires_unlit(output), requires_unlit(input), 'unlit is used, not required')
}

// All of the above and the validator. Answers { input, output } for further questions.
export async function check_baked(input_file, output_file) {
  assert.deepEqual(await new_errors(input_file, output_file), [])
  const input = read_gltf(input_file)
  const output = read_gltf(output_file)
  check_primitives(input, output)
  check_nothing_is_lost(input, output)
  const { radiosity } = output.json.asset.extras
  assert.ok(radiosity.exposure > 0, 'asset.extras.radiosity names the exposure')
  return { input, output }
}
