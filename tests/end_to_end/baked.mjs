// What must hold for every baked file, whatever the scene.
import assert from 'node:assert/strict'
import { read_compressed } from './compressed_file.mjs'
import {
  copy_count, image_bytes, nodes_of_scene, primitives_of_node, primitives_of_scene, read_accessor, read_gltf, view_bytes,
} from './gltf_file.mjs'
import { differences, exact_json } from './json_differences.mjs'
import { new_errors } from './validator.mjs'

const unlit = 'KHR_materials_unlit'
const specular_glossiness = 'KHR_materials_pbrSpecularGlossiness'
const draco = 'KHR_draco_mesh_compression'
const meshopt = 'EXT_meshopt_compression'
// A shading extension has no effect on an unlit material; nor has anything else that bends, coats or scatters light.
const is_shading = (name) => /^KHR_materials_(?!unlit|variants)/.test(name)

export const material_of = ({ json }, primitive) => json.materials?.[primitive.material] ?? {}
export const is_unlit = (material) => material.extensions?.[unlit] !== undefined
export const has_triangles = ({ mode = 4 }) => mode >= 4

// COLOR_0 of a primitive, as rows of numbers.
export const colors_of = (gltf, primitive) => read_accessor(gltf, primitive.attributes.COLOR_0)

// What lets all light through stays as it is, as what is unlit does.
function is_clear({ extensions = {} }) {
  const { transmissionFactor = 0, transmissionTexture } = extensions.KHR_materials_transmission ?? {}
  return transmissionFactor === 1 && transmissionTexture === undefined
}

// Whether COLOR_0 must have been written: triangles with vertices and a material that shows light.
function receives(gltf, primitive) {
  const position = gltf.json.accessors?.[primitive.attributes.POSITION]
  const material = material_of(gltf, primitive)
  return has_triangles(primitive) && position !== undefined && !is_unlit(material) && !is_clear(material)
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

// The textures that an unlit material may show: that of the base colour, or of what is emitted where nothing is transparent.
function textures_to_show({ alphaMode = 'OPAQUE', pbrMetallicRoughness, emissiveTexture, extensions }) {
  const glossy = extensions?.[specular_glossiness]
  const base_color = glossy ? glossy.diffuseTexture : pbrMetallicRoughness?.baseColorTexture
  return alphaMode === 'OPAQUE' && emissiveTexture !== undefined ? [base_color, emissiveTexture] : [base_color]
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
  const shown = textures_to_show(before).map((texture) => JSON.stringify(texture))
  assert.ok(shown.includes(JSON.stringify(pbr.baseColorTexture)), `${place}: texture`)
  assert.deepEqual(Object.keys(material.extensions).filter(is_shading), [], `${place}: extensions of the material`)
}

// Every primitive of the default scene carries its light, or is what it was.
export function check_primitives(input, output) {
  const shown = visible_nodes(input)
  for (const [node, primitive, k] of primitives_of_scene(input)) {
    for (const node_after of nodes_after(input, output, node)) {
      const baked = primitives_of_node(output, node_after)[k][1]
      const place = `nodes[${node}] primitive ${k}`
      if (shown.has(node) && receives(input, primitive)) {
        check_colors(output, baked, place)
        check_material(output, baked, { gltf: input, primitive }, place)
      } else {
        assert.deepEqual(material_of(output, baked), material_of(input, primitive), place)
        assert.equal(node_after, node)
      }
    }
  }
}

// The nodes that show a node's mesh after the bake: instanced copies that were baked have become its last children.
function nodes_after(input, output, node) {
  const expanded = copy_count(input, node) > 0 && copy_count(output, node) === 0
  return expanded ? output.json.nodes[node].children.slice(-copy_count(input, node)) : [node]
}

// Those of the default scene that KHR_node_visibility does not hide.
function visible_nodes(gltf) {
  const is_hidden = (node) => gltf.json.nodes[node].extensions?.KHR_node_visibility?.visible === false
  return new Set(nodes_of_scene(gltf, (node) => !is_hidden(node)))
}

const without = (object = {}, ...keys) => Object.fromEntries(Object.entries(object).filter(([key]) => !keys.includes(key)))

// What a bake may change in a tree, as patterns of JSON pointers; $ stands for the index of something that is new.
const allowed = [
  // The signature.
  '/asset/extras(/radiosity)?',
  // All data is in one buffer; what is new comes after what there was.
  '/buffers/0(/(byteLength|uri|extensions|extras(/radiosity)?))?', '/buffers/\\d+',
  '/bufferViews/\\d+/(buffer|byteOffset|extensions)', '/bufferViews/$', '/bufferViews',
  '/images/\\d+/(uri|bufferView|mimeType)',
  '/accessors/$',
  // Compressed data became plain.
  '/accessors/\\d+/(bufferView|byteOffset|(min|max)/\\d+)',
  // What a baked primitive is made of.
  '/meshes/$', '/meshes/\\d+/primitives/\\d+/(attributes/[^/]+|targets/\\d+/[^/]+|indices|material|mode)',
  '/meshes/\\d+/primitives/\\d+/extensions(/KHR_materials_variants|/KHR_draco_mesh_compression)?',
  '/nodes/\\d+/mesh',
  '/materials', '/materials/$',
]
// In a material that has become unlit where it stood.
const allowed_in_unlit = [
  '/(emissiveFactor|emissiveTexture|normalTexture|occlusionTexture)(/.*)?',
  '/pbrMetallicRoughness(/(baseColorFactor|metallicFactor|roughnessFactor|metallicRoughnessTexture)(/.*)?)?',
  '/extensions(/(KHR|EXT|ADOBE)_materials_[^/]*(/.*)?)?',
]
// Where instanced copies have become nodes.
const allowed_with_instances = [
  '/nodes/$', '/nodes/\\d+/(mesh|weights|children|extensions)', '/nodes/\\d+/(children|extensions)/[^/]+',
  '/animations/\\d+/channels/\\d+/target/node', '/animations/\\d+/channels/$',
]

// Whether a difference fits one of the patterns.
function fits(patterns, { pointer, before, after }) {
  return patterns.some((pattern) => {
    const is_new = pattern.includes('$')
    return new RegExp(`^${pattern.replace('$', '\\d+')}$`).test(pointer) && !(is_new && before !== undefined && after !== undefined)
  })
}

// Differences that no bake may make.
function forbidden(before, after) {
  const instanced = before.nodes?.some(({ extensions }) => extensions?.EXT_mesh_gpu_instancing !== undefined)
  return differences(before, after).filter((difference) => {
    const { pointer } = difference
    if (/^\/extensions(Used|Required)/.test(pointer) || fits(allowed, difference)) return false
    if (instanced && fits(allowed_with_instances, difference)) return false
    const [, index, rest] = /^\/materials\/(\d+)(\/.*)$/.exec(pointer) ?? []
    const baked = index !== undefined && is_unlit(after.materials[index]) && !is_unlit(before.materials[index])
    if (!baked) return true
    const { pbrMetallicRoughness: { baseColorTexture } = {} } = before.materials[index]
    const replaces_texture = textures_to_show(before.materials[index]).some((texture) => texture !== baseColorTexture)
    const patterns = replaces_texture ? [...allowed_in_unlit, '/pbrMetallicRoughness/baseColorTexture(/.*)?'] : allowed_in_unlit
    return !fits(patterns, { ...difference, pointer: rest })
  })
}

// Where a primitive keeps its positions, it keeps everything but COLOR_0.
function check_geometry(before, after, place) {
  if (before.attributes.POSITION !== after.attributes.POSITION) return
  if (before.extensions?.[draco] !== undefined) return
  assert.deepEqual(without(after.attributes, 'COLOR_0'), without(before.attributes, 'COLOR_0'), place)
  assert.deepEqual([after.indices, after.mode, after.targets], [before.indices, before.mode, before.targets], place)
}

// The extras of a primitive before its reflectance was noted in them.
function without_note(extras) {
  if (extras?.radiosity === undefined) return extras
  const { radiosity, ...rest } = extras
  const keys = Object.keys(rest)
  if (keys.length === 0) return undefined
  return keys.join() === 'original' ? rest.original : rest
}

// The same for a whole tree.
function without_notes(json) {
  for (const { primitives } of json.meshes ?? []) {
    for (const primitive of primitives) {
      primitive.extras = without_note(primitive.extras)
      if (primitive.extras === undefined) delete primitive.extras
    }
  }
  return json
}

// A copy of a mesh keeps what describes it, and every attribute.
function check_mesh(before, after, place) {
  const described = ({ primitives, ...mesh }) => ({
    ...mesh,
    primitives: primitives.map(({ extras, extensions, targets }) => (
      { extras: without_note(extras), extensions: without(extensions, draco, 'KHR_materials_variants'), targets: targets?.map(Object.keys) })),
  })
  assert.deepEqual(described(after), described(before), place)
  before.primitives.forEach(({ attributes }, k) => {
    for (const name of Object.keys(attributes)) assert.ok(name in after.primitives[k].attributes, `${place} has lost a ${name}`)
  })
}

function check_extensions(before, after, { data_moves }) {
  const declared = ({ extensionsUsed = [], extensionsRequired = [] }) => [extensionsUsed, extensionsRequired]
  const may_go = (name) => [draco, meshopt, 'EXT_mesh_gpu_instancing'].includes(name) || is_shading(name)
  const names_after = declared(after)
  declared(before).forEach((names, k) => {
    for (const name of names) assert.ok(names_after[k].includes(name) || may_go(name), `${name} is not declared any more`)
    const compresses = (name) => data_moves && [draco, meshopt].includes(name)
    const added = names_after[k].filter((name) => !names.includes(name) && !compresses(name))
    assert.deepEqual(added.filter((name) => k === 1 || name !== unlit), [], 'declared anew; unlit is used, not required')
  })
}

// Buffers become one, which writes down what described the others; placeholders of compressed data are none.
function check_buffers({ buffers: [, ...others] = [] }, { buffers: [merged] = [] }) {
  const is_placeholder = ({ extensions }) => extensions?.[meshopt] !== undefined
  const described = others.filter((buffer) => !is_placeholder(buffer)).map((buffer) => without(buffer, 'uri', 'byteLength'))
  assert.deepEqual(merged.extras?.radiosity?.merged ?? [], described.filter((buffer) => Object.keys(buffer).length > 0))
}

// Every byte that the tree refers to is where it was, but for those that were compressed.
function check_data(input, output) {
  const is_compressed = (view) => view.extensions?.[meshopt] !== undefined
  for (const [index, view] of (input.json.bufferViews ?? []).entries()) {
    if (is_compressed(view)) continue
    assert.ok(view_bytes(input, index).equals(view_bytes(output, index)), `bufferViews[${index}] changed`)
  }
}

function check_images(input, output) {
  for (const [index] of (input.json.images ?? []).entries()) {
    assert.ok(image_bytes(input, index).equals(image_bytes(output, index)), `images[${index}] changed`)
  }
}

// A tree that does not care where its data lies: what accessors hold stands where their numbers were, but for meshes, whose
// vertices may be in another order.
function with_data(tree, gltf) {
  const { accessors = [], bufferViews, buffers, ...moved } = structuredClone(tree)
  const hold = (object, key) => {
    if (object[key] === undefined) return
    object[key] = { ...without(accessors[object[key]], 'bufferView', 'byteOffset', 'sparse', 'min', 'max'), rows: read_accessor(gltf, object[key]) }
  }
  moved.skins?.forEach((skin) => hold(skin, 'inverseBindMatrices'))
  moved.animations?.forEach(({ samplers = [] }) => samplers.forEach((sampler) => ['input', 'output'].forEach((key) => hold(sampler, key))))
  moved.nodes?.forEach(({ extensions }) => {
    const attributes = extensions?.EXT_mesh_gpu_instancing?.attributes ?? {}
    Object.keys(attributes).forEach((name) => hold(attributes, name))
  })
  moved.images?.forEach((image) => { delete image.bufferView })
  return moved
}

// Everything a bake does not understand is where it was, to the last digit and byte. With `data_moves` accessors and
// bufferViews may be others, compressed ones too, if they hold the same.
export function check_nothing_is_lost(input_file, output_file, { data_moves = false } = {}) {
  const [before, after] = [exact_json(input_file), without_notes(exact_json(output_file))]
  const [input, output] = [input_file, output_file].map(data_moves ? read_compressed : read_gltf)
  if (data_moves) {
    assert.deepEqual(forbidden(with_data(before, input), with_data(after, output)), [])
  } else {
    assert.deepEqual(forbidden(before, after), [])
    check_data(input, output)
  }
  check_extensions(before, after, { data_moves })
  check_buffers(before, after)
  check_images(input, output)
  before.nodes?.forEach(({ mesh }, node) => {
    if (mesh === undefined) return
    for (const now of nodes_after(input, output, node)) {
      const [was, is] = [before.meshes[mesh], after.meshes[after.nodes[now].mesh]]
      check_mesh(was, is, `the mesh of nodes[${node}]`)
      if (data_moves) continue
      was.primitives.forEach((primitive, k) => check_geometry(primitive, is.primitives[k], `nodes[${node}], primitive ${k}`))
    }
  })
}

// All of the above and the validator. Answers { input, output } for further questions, of plain data if it moves.
export async function check_baked(input_file, output_file, { data_moves = false } = {}) {
  assert.deepEqual(await new_errors(input_file, output_file), [])
  const [input, output] = [input_file, output_file].map(data_moves ? read_compressed : read_gltf)
  check_primitives(input, output)
  check_nothing_is_lost(input_file, output_file, { data_moves })
  const { radiosity } = output.json.asset.extras
  assert.ok(radiosity.exposure > 0, 'asset.extras.radiosity names the exposure')
  return { input, output }
}
