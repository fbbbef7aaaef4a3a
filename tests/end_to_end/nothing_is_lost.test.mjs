// Geometry, extras, extensions, images, skins, animations: what a bake does not need, it leaves alone.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { check_baked, check_nothing_is_lost, colors_of, has_triangles } from './baked.mjs'
import { bake, cheapest, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { primitives_of_scene, read_accessor, read_gltf, to_glb, triangles_of, view_bytes } from './gltf_file.mjs'

const folder = temporary_folder()

// { input, output } of a bake that passed every check of check_baked.
async function baked(scene, output, ...options) {
  const target = path.join(folder, output)
  bake(test_asset(scene), target, ...cheapest, ...options)
  return check_baked(test_asset(scene), target)
}

function area_of(gltf, primitive) {
  const positions = read_accessor(gltf, primitive.attributes.POSITION)
  return triangles_of(gltf, primitive).reduce((sum, [a, b, c]) => {
    const [u, v] = [b, c].map((corner) => positions[corner].map((x, k) => x - positions[a][k]))
    return sum + Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
  }, 0)
}

const areas = (gltf) => primitives_of_scene(gltf)
  .filter(([, primitive]) => has_triangles(primitive))
  .map(([, primitive]) => area_of(gltf, primitive))

test('integers beyond 53 bits, null, empty objects and tiny numbers in extras survive', async () => {
  const { input, output } = await baked('extras_everywhere.glb', 'extras.glb')
  // JavaScript cannot hold these integers: count their digits in the text.
  const count = (file) => fs.readFileSync(file, 'latin1').split('9007199254740993').length
  assert.ok(count(path.join(folder, 'extras.glb')) >= count(test_asset('extras_everywhere.glb')))
  assert.equal(output.json.scenes.length, input.json.scenes.length)
})

test('the comparison of trees and bytes sees what is lost', async () => {
  const target = path.join(folder, 'whole.glb')
  const scene = test_asset('torture.gltf')
  bake(scene, target, ...cheapest, '--refine', 'none')
  check_nothing_is_lost(scene, target)
  const { json, buffers: [binary] } = read_gltf(target)
  const losses = {
    'an extra': (tree) => { delete tree.samplers[0].extras.none },
    'an empty object': (tree) => { delete tree.asset.extras.empty },
    'an unknown extension': (tree) => { delete tree.animations[0].samplers[0].extensions },
    'an animation pointer': (tree) => { tree.animations[0].channels[2].target.extensions.KHR_animation_pointer.pointer = '' },
    'a name': (tree) => { tree.images[2].name = 'x' },
    'a camera': (tree) => { tree.cameras.pop() },
    'another scene': (tree) => { tree.scenes.pop() },
    'a joint': (tree) => { tree.skins[0].joints.pop() },
    'a texture of a material that is not baked': (tree) => { delete tree.materials[2].occlusionTexture },
    'the colour of an unlit material': (tree) => { tree.materials[1].pbrMetallicRoughness.baseColorFactor[0] = 1 },
    'the extras of a second buffer': (tree) => { tree.buffers[0].extras.radiosity.merged[0].extras.none = 1 },
    'a declaration': (tree) => { tree.extensionsUsed.shift() },
    'the name of a copied mesh': (tree) => { tree.meshes.at(-1).name = 'x' },
    'a byte': (tree, bytes) => { bytes[view_bytes({ json: tree, buffers: [bytes] }, 0).byteOffset - bytes.byteOffset] ^= 1 },
  }
  for (const [what, lose] of Object.entries(losses)) {
    const [tree, bytes] = [structuredClone(json), Buffer.from(binary)]
    lose(tree, bytes)
    const damaged = path.join(folder, 'damaged.glb')
    fs.writeFileSync(damaged, to_glb(tree, bytes))
    assert.throws(() => check_nothing_is_lost(scene, damaged), assert.AssertionError, `${what} went unnoticed`)
  }
})

test('a bake of one scene leaves the others alone', async () => {
  const target = path.join(folder, 'second.glb')
  const scene = test_asset('torture.gltf')
  bake(scene, target, ...cheapest, '--scene', 1, '--refine', 'none')
  check_nothing_is_lost(scene, target)
  const { json } = read_gltf(target)
  const is_baked = ({ mesh }) => json.meshes[mesh].primitives.every(({ attributes }) => attributes.COLOR_0 !== undefined)
  const named = (name) => json.nodes.find((node) => node.name === name)
  assert.ok(is_baked(named('shared')) && is_baked(named('own')))
  assert.ok(!is_baked(named('plane')) && !is_baked(named('again')))
  const few = ['--points', 50, '--max-samples', 64, '--progress', 'none']
  assert.equal(run('verify', scene, target, '--scene', 1, ...few).code, 0, 'verify finds what is baked in that scene')
  assert.equal(run('verify', scene, target, ...few).code, 1, 'and nothing in the other')
  const { code, lines } = run(scene, target, '--scene', 2, '--progress', 'none')
  assert.equal(code, 2)
  assert.match(lines[0], /--scene: there is no scene 2/)
})

test('a mesh that was unlit stays as it was', async () => {
  const { input, output } = await baked('extras_everywhere.glb', 'unlit.glb')
  const sign = input.json.nodes.findIndex(({ name }) => name === 'sign')
  const [before, after] = [input, output].map((gltf) => primitives_of_scene(gltf).find(([node]) => node === sign)[1])
  assert.equal(after.attributes.COLOR_0, undefined)
  assert.deepEqual(after, before)
})

for (const refine of ['none', 'uniform']) {
  test(`no triangle is lost at a non-manifold edge (--refine ${refine})`, async () => {
    const { input, output } = await baked('non_manifold.glb', `fins_${refine}.glb`, '--refine', refine)
    const [[, before]] = primitives_of_scene(input)
    const [[, after]] = primitives_of_scene(output)
    const counts = [before, after].map((primitive, k) => triangles_of([input, output][k], primitive).length)
    if (refine === 'none') assert.equal(counts[1], counts[0])
    else assert.ok(counts[1] > counts[0], `${counts[1]} triangles, the source had ${counts[0]}`)
  })

  for (const scene of ['non_manifold', 'strip', 'uv_seam', 'mirrored_instance', 'skinned_and_morphed', 'cornell_box']) {
    test(`${scene} keeps its area (--refine ${refine})`, async () => {
      const { input, output } = await baked(`${scene}.glb`, `${scene}_${refine}.glb`, '--refine', refine)
      areas(input).forEach((area, k) => assert.ok(Math.abs(areas(output)[k] / area - 1) < 1e-5, `primitive ${k}`))
    })
  }
}

test('--simplify leaves out what is not needed and moves nothing that stays', async () => {
  const [one, two] = ['1', '2'].map((threads) => path.join(folder, `simplified_${threads}.glb`))
  const bake_on = (threads, target) => bake(test_asset('cornell_box_1500.glb'), target, ...cheapest,
    '--refine', 'none', '--simplify', '--max-error', 0.1, '--threads', threads)
  const report = bake_on(1, one)
  const { input, output } = await check_baked(test_asset('cornell_box_1500.glb'), one)
  assert.ok(report.outputVertices < report.inputVertices / 2, `${report.outputVertices} of ${report.inputVertices}`)
  assert.equal(report.removedVertices, report.inputVertices - report.outputVertices)
  areas(input).forEach((area, k) => assert.ok(Math.abs(areas(output)[k] / area - 1) < 1e-4, `primitive ${k}`))

  const primitives = [input, output].map((gltf) => primitives_of_scene(gltf).map(([, primitive]) => primitive))
  primitives[1].forEach((primitive, k) => {
    for (const semantic of ['POSITION', 'NORMAL']) {
      const rows = (gltf, { attributes }) => read_accessor(gltf, attributes[semantic]).map(String)
      const known = new Set(rows(input, primitives[0][k]))
      for (const row of rows(output, primitive)) assert.ok(known.has(row), `${semantic} ${row} of primitive ${k}`)
    }
  })

  bake_on(2, two)
  assert.ok(fs.readFileSync(one).equals(fs.readFileSync(two)), 'one thread and two write the same')
})

test('skins, weights and morph targets follow the subdivision', async () => {
  const fine = ['--refine', 'uniform', '--patch-size', 0.06]
  const { input, output } = await baked('skinned_and_morphed.glb', 'moving.glb', ...fine)
  for (const [k, [, primitive]] of primitives_of_scene(output).entries()) {
    const count = (index) => output.json.accessors[index].count
    const vertices = count(primitive.attributes.POSITION)
    assert.ok(vertices > input.json.accessors[primitives_of_scene(input)[k][1].attributes.POSITION].count)
    for (const index of Object.values(primitive.attributes)) assert.equal(count(index), vertices)
    for (const target of primitive.targets ?? []) {
      for (const index of Object.values(target)) assert.equal(count(index), vertices)
    }
    if (primitive.attributes.WEIGHTS_0 === undefined) continue
    for (const weights of read_accessor(output, primitive.attributes.WEIGHTS_0)) {
      assert.ok(Math.abs(weights.reduce((sum, weight) => sum + weight) - 1) < 1e-5, `weights ${weights}`)
    }
  }
})

test('points and lines stay beside the baked triangles', async () => {
  const { input, output } = await baked('points_and_lines.glb', 'points.glb')
  const [before, after] = [input, output].map((gltf) => primitives_of_scene(gltf).map(([, primitive]) => primitive))
  for (const k of [0, 2]) assert.deepEqual(after[k], before[k])
  assert.notEqual(after[1].attributes.COLOR_0, undefined)
})

test('two nodes with one mesh get a COLOR_0 each and share the rest', async () => {
  const { output } = await baked('mirrored_instance.glb', 'instances.glb', '--refine', 'none')
  const [right, left] = primitives_of_scene(output).map(([, primitive]) => primitive)
  assert.notEqual(left.attributes.COLOR_0, right.attributes.COLOR_0)
  for (const key of ['POSITION', 'NORMAL']) assert.equal(left.attributes[key], right.attributes[key])
  assert.equal(left.indices, right.indices)
})

test('the subdivision of one node can be asked for by name, whatever holds for the others', async () => {
  for (const options of [['--refine', 'none'], ['--refine', 'uniform'], ['--patch-size', '0.05']]) {
    const { input, output } = await baked('unit_cube.glb', 'level.glb', ...options, '--subdivide', 'cube=2')
    const count = (gltf) => triangles_of(gltf, primitives_of_scene(gltf)[0][1]).length
    assert.equal(count(output), 16 * count(input), options.join(' '))
  }
})

test('.glb, .gltf and .embedded.gltf hold the same colours and images', async () => {
  const outputs = ['same.glb', 'same.gltf', 'same.embedded.gltf']
  for (const scene of ['multi_buffer.gltf', 'textured_interior.glb']) {
    const colors = []
    for (const name of outputs) {
      const { output } = await baked(scene, name, '--refine', 'none')
      colors.push(primitives_of_scene(output).map(([, primitive]) => colors_of(output, primitive)))
      const uris = [...output.json.buffers, ...(output.json.images ?? [])].map(({ uri }) => uri).filter(Boolean)
      if (name === 'same.glb') assert.deepEqual(uris, [])
      const all_inside = uris.every((uri) => uri.startsWith('data:'))
      assert.ok(name !== 'same.embedded.gltf' || all_inside, 'everything in one file')
    }
    assert.deepEqual(colors[1], colors[0])
    assert.deepEqual(colors[2], colors[0])
  }
})

test('a .gltf baked to another folder takes its images along', async () => {
  const away = path.join(folder, 'away')
  fs.mkdirSync(away)
  await baked('multi_buffer.gltf', 'away/baked.gltf')
})

test('integer colours are the float colours, rounded; 8 bits up or down', async () => {
  const [reference, u16, u8] = await Promise.all(['float', 'u16', 'u8'].map(async (type) => {
    const { output } = await baked('occluder.glb', `${type}.glb`, '--refine', 'none', '--color-type', type)
    const accessor = output.json.accessors[primitives_of_scene(output)[0][1].attributes.COLOR_0]
    assert.deepEqual([accessor.componentType, accessor.normalized ?? false],
      { float: [5126, false], u16: [5123, true], u8: [5121, true] }[type])
    return primitives_of_scene(output).flatMap(([, primitive]) => colors_of(output, primitive).flat())
  }))
  for (const [values, step] of [[u16, 0.5001 / 65535], [u8, 0.9999 / 255]]) {
    values.forEach((value, k) => assert.ok(Math.abs(value - reference[k]) <= step))
  }
})

// A triangle in a .gltf with these nodes.
function write_nodes(name, nodes) {
  const numbers = new Float32Array([0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 1, 0, 0, 1, 0])
  const view = (byteOffset) => ({ buffer: 0, byteOffset, byteLength: 36 })
  const accessor = (bufferView) => ({ bufferView, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, -1], max: [1, 1, 0] })
  const file = path.join(folder, name)
  fs.writeFileSync(file, JSON.stringify({
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    nodes,
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 } }] }],
    accessors: [accessor(0), accessor(1)],
    bufferViews: [view(0), view(36)],
    buffers: [{ byteLength: 72, uri: `data:;base64,${Buffer.from(numbers.buffer).toString('base64')}` }],
  }))
  return file
}

const translation = [0, 0.001, 0]
const deep = Array.from({ length: 10_000 }, (_, i) => ({ translation, children: [i + 1] }))
const wide = Array.from({ length: 100_000 }, (_, i) => (
  { name: `${i}`, translation: [2 * i, 0, 0], ...(i % 50_000 === 1 ? { mesh: 0 } : {}) }))
for (const [name, nodes] of [
  ['10,000 levels of nodes', [...deep, { mesh: 0 }]],
  ['100,000 nodes side by side', [{ children: wide.map((_, i) => i + 1) }, ...wide]],
]) {
  test(`${name} are walked in no time and kept`, () => {
    const input = write_nodes('many.gltf', nodes)
    const output = path.join(folder, 'many.glb')
    const { code, seconds, stderr } = run(input, output, ...cheapest, '--refine', 'none')
    assert.equal(code, 0, stderr)
    assert.ok(seconds < (sanitized() ? 60 : 10), `took ${seconds} s`)
    check_nothing_is_lost(input, output)
    const baked = primitives_of_scene(read_gltf(output))
    assert.equal(baked.length, nodes.filter(({ mesh }) => mesh === 0).length)
    for (const [, primitive] of baked) assert.notEqual(primitive.attributes.COLOR_0, undefined)
  })
}
