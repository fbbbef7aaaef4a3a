// Features that touch the same parts of a file, together.
import assert from 'node:assert/strict'
import path from 'node:path'
import test from 'node:test'
import { check_nothing_is_lost, is_unlit, material_of } from './baked.mjs'
import { bake, cheapest, run, temporary_folder, test_asset } from './command_line.mjs'
import { read_compressed } from './compressed_file.mjs'
import { copy_count, primitives_of_node, primitives_of_scene, triangles_of } from './gltf_file.mjs'
import { new_errors } from './validator.mjs'

const folder = temporary_folder()
const compressions = [['--draco'], ['--meshopt']]

// { gltf, report }: the plain contents of a bake that the validator has nothing against and that has lost nothing.
async function baked(scene, ...options) {
  const output = path.join(folder, 'baked.glb')
  const report = bake(test_asset(scene), output, ...cheapest, ...options)
  assert.deepEqual(await new_errors(test_asset(scene), output), [], options.join(' '))
  check_nothing_is_lost(test_asset(scene), output, { data_moves: true })
  return { gltf: read_compressed(output), report }
}

const node_called = ({ json }, name) => json.nodes.findIndex((node) => node.name === name)
// The accessors that something refers to.
function used_accessors({ json }) {
  const of_primitives = json.meshes.flatMap(({ primitives }) => primitives)
    .flatMap(({ attributes, indices, targets = [] }) => [indices, ...[attributes, ...targets].flatMap(Object.values)])
  const of_samplers = (json.animations ?? []).flatMap(({ samplers }) => samplers).flatMap(({ input, output }) => [input, output])
  const of_instances = json.nodes.flatMap(({ extensions }) => Object.values(extensions?.EXT_mesh_gpu_instancing?.attributes ?? {}))
  return new Set([...of_primitives, ...of_samplers, ...of_instances])
}

// Whether every primitive of a node shows its light.
const shows_light = (gltf, name) => primitives_of_node(gltf, node_called(gltf, name)).every(([, primitive]) =>
  primitive.attributes.COLOR_0 !== undefined && is_unlit(material_of(gltf, primitive)))

test('instances that are not selected stay instances, compressed or not', async () => {
  for (const compression of [[], ...compressions]) {
    const { gltf } = await baked('instanced.glb', '--refine', 'none', '--select', 'floor', ...compression)
    const stones = node_called(gltf, 'stones')
    assert.equal(copy_count(gltf, stones), 3)
    assert.ok(shows_light(gltf, 'floor') && !shows_light(gltf, 'stones'))
    assert.ok(gltf.json.extensionsUsed.includes('EXT_mesh_gpu_instancing'))
  }
})

test('instances that are selected become nodes, and the accessors of their places leave a compressed file', async () => {
  for (const compression of compressions) {
    const { gltf } = await baked('instanced.glb', '--refine', 'none', '--select', 'stones', ...compression)
    for (const k of [0, 1, 2]) assert.ok(shows_light(gltf, `stones[${k}]`))
    assert.ok(!shows_light(gltf, 'floor'))
    assert.deepEqual([...gltf.json.accessors.keys()].filter((index) => !used_accessors(gltf).has(index)), [])
  }
})

test('simplified meshes are compressed as they are, with all that their vertices carry', async () => {
  const options = ['--refine', 'none', '--simplify', '--max-error', 0.1, '--radiance-attribute', 'LIGHT', '--exclude', 'tall_block']
  for (const compression of [[], ...compressions]) {
    const { gltf, report } = await baked('cornell_box_1500.glb', ...options, ...compression)
    assert.ok(report.removedVertices > report.outputVertices / 4, `${report.removedVertices} vertices left out`)
    let vertices = 0, triangles = 0
    for (const [, primitive] of primitives_of_scene(gltf)) {
      const counts = new Set(Object.values(primitive.attributes).map((index) => gltf.json.accessors[index].count))
      assert.equal(counts.size, 1, 'one row per vertex')
      vertices += [...counts][0]
      triangles += triangles_of(gltf, primitive).length
      assert.equal(primitive.attributes._LIGHT !== undefined, primitive.attributes.COLOR_0 !== undefined)
    }
    assert.deepEqual([vertices, triangles], [report.outputVertices, report.outputTriangles], compression.join())
  }
})

test('--select looks for names in the scene that --scene names', async () => {
  const scene = ['--scene', 1, '--refine', 'none']
  const { gltf } = await baked('torture.gltf', ...scene, '--select', 'own')
  assert.ok(shows_light(gltf, 'own') && !shows_light(gltf, 'shared') && !shows_light(gltf, 'plane'))
  const { code, lines } = run(test_asset('torture.gltf'), path.join(folder, 'no.glb'), '--progress', 'none', ...scene, '--select', 'plane')
  assert.equal(code, 2)
  assert.deepEqual(lines, ['gltf-radiosity: error: --select: no node of the scene is called "plane"'])
})
