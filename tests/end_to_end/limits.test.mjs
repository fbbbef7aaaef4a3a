// What a file claims and what a bake may take: refused at once with one line that names the place, or done within it.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { check_baked } from './baked.mjs'
import { cheapest, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { read_gltf, to_glb } from './gltf_file.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)

function changed(asset, change) {
  const { json, buffers } = read_gltf(test_asset(asset))
  const binary = Buffer.from(buffers[0])
  const replaced = change(json, binary)
  const file = target('claims.glb')
  fs.writeFileSync(file, to_glb(replaced?.json ?? json, replaced?.binary ?? binary))
  return file
}

function assert_refused(code, reason, input, ...options) {
  const { code: ended, stdout, lines, seconds } =
    run(input, target('out.glb'), '--progress', 'none', '--max-memory', '1G', ...options)
  assert.equal(ended, code, lines.join('\n'))
  assert.equal(stdout, '')
  assert.equal(lines.length, 1, lines.join('\n'))
  assert.match(lines[0], reason)
  assert.ok(!fs.existsSync(target('out.glb')))
  assert.ok(seconds < (sanitized() ? 60 : 10), `took ${seconds} s`)
}

const chunk_length = 12

test('four billion vertices without data', () => {
  assert_refused(4, /accessors\[\d\]: 4000000000 elements need about/, changed('unit_cube.glb', (json) => {
    for (const accessor of json.accessors.filter(({ type }) => type !== 'SCALAR')) {
      delete accessor.bufferView
      accessor.count = 4e9
    }
  }))
})

test('a mesh that is small in the file and large in ten thousand nodes', () => {
  assert_refused(4, /meshes\[0\]\.primitives\[0\] of nodes\[\d+\]: 1 times \d+ vertices and \d+ triangles need/, changed('cornell_box_5000.glb', (json) => {
    const [node] = json.nodes.filter(({ mesh }) => mesh !== undefined)
    json.nodes = Array.from({ length: 10_000 }, () => ({ mesh: node.mesh }))
    json.scenes = [{ nodes: json.nodes.map((_, i) => i) }]
    json.scene = 0
  }), '--max-memory', '512M')
})

test('instances times vertices', () => {
  assert_refused(4, /nodes\[\d\]: \d+ instances need about/, changed('unit_cube.glb', (json) => {
    json.bufferViews.push({ buffer: 0, byteLength: 12 }, { buffer: 0, byteLength: 1 })
    const indices = { bufferView: json.bufferViews.length - 1, componentType: 5121 }
    const sparse = { count: 1, indices, values: { bufferView: json.bufferViews.length - 2 } }
    json.accessors.push({ componentType: 5126, count: 16_000_000, type: 'VEC3', sparse })
    const TRANSLATION = json.accessors.length - 1
    json.nodes[0].extensions = { EXT_mesh_gpu_instancing: { attributes: { TRANSLATION } } }
  }))
})

test('Draco data that claims a billion triangles', () => {
  // After the header of 11 bytes and, for EdgeBreaker, a byte for the traversal, come two numbers of 7 bits a byte.
  const claim = (json, binary, triangles) => {
    const { bufferView } = json.meshes[0].primitives[0].extensions.KHR_draco_mesh_compression
    const at = json.bufferViews[bufferView].byteOffset ?? 0
    assert.equal(binary.toString('latin1', at, at + 5), 'DRACO')
    const numbers = at + (binary[at + 8] === 1 ? 12 : 11)
    const varint = []
    for (let rest = triangles; rest > 0; rest = Math.floor(rest / 128)) varint.push((rest % 128) | (rest >= 128 ? 128 : 0))
    Buffer.from([...varint, ...varint]).copy(binary, numbers)
  }
  assert_refused(1, /meshes\[0\]\.primitives\[0\]: Draco holds 3000000000 indices where the accessor says/,
    changed('draco_box.glb', (json, binary) => claim(json, binary, 1e9)))
  assert_refused(4, /accessors\[\d\]: 3000000000 elements need about/, changed('draco_box.glb', (json, binary) => {
    claim(json, binary, 1e9)
    json.accessors[json.meshes[0].primitives[0].indices].count = 3e9
  }))
})

test('a GLB whose chunk is longer than the file', () => {
  const bytes = fs.readFileSync(test_asset('unit_cube.glb'))
  bytes.writeUInt32LE(0xffffffff, chunk_length)
  fs.writeFileSync(target('chunk.glb'), bytes)
  assert_refused(1, /GLB chunk 0: reaches beyond the end of the file/, target('chunk.glb'))
})

test('a JSON of many empty values', () => {
  const values = `[${'[],'.repeat(4_000_000)}0]`
  const { json } = read_gltf(test_asset('unit_cube.glb'))
  fs.writeFileSync(target('values.gltf'), JSON.stringify({ ...json, extras: 0 }).replace('"extras":0', `"extras":${values}`))
  assert_refused(4, /JSON: \d+ values need about/, target('values.gltf'))
})

test('a file that has no end', () => assert_refused(4, /\/dev\/zero: the file is too large: of --max-memory \d+ bytes are left/, '/dev/zero', '--max-memory', '64M'))

test('nodes nested ten thousand deep are no matter', () => {
  const deep = changed('unit_cube.glb', (json) => {
    const depth = 10_000
    const mesh = json.nodes[0].mesh
    json.nodes = Array.from({ length: depth }, (_, i) => (i + 1 < depth ? { children: [i + 1] } : { mesh }))
    json.scenes = [{ nodes: [0] }]
    json.scene = 0
  })
  const { code, stderr } = run(deep, target('deep.glb'), '--progress', 'none', ...cheapest, '--sky', '1,1,1')
  assert.equal(code, 0, stderr)
})

test('a mesh is not cut beyond the memory that there is', () => {
  const file = target('report.json')
  const { code, stderr } = run(test_asset('cornell_box.glb'), target('cut.glb'), '--progress', 'none', '--quality', 'draft',
    '--max-patches', 100, '--refine', 'uniform', '--patch-size', '0.0001', '--max-memory', '64M', '--json', file)
  assert.equal(code, 0, stderr)
  const { warnings, phases } = JSON.parse(fs.readFileSync(file, 'utf8'))
  assert.ok(warnings.some(({ code: name }) => name === 'element-limit'))
  const peak = Math.max(...phases.map(({ peakMemoryBytes }) => peakMemoryBytes)) / 2 ** 20
  assert.ok(sanitized() || peak < 64, `${peak} MiB`)
})

test('when time is up the light that there is by then is written, with 4 and a warning', async () => {
  const file = target('report.json')
  const input = test_asset('cornell_box.glb')
  const limit = sanitized() ? 40 : 4
  const { code, stderr, seconds } = run(input, target('timed.glb'), '--progress', 'none', '--quality', 'draft', '--max-patches', 200,
    '--max-error', '0.00001', '--max-vertices', 1_000_000, '--time-limit', limit, '--json', file)
  assert.equal(code, 4, stderr)
  assert.match(stderr, /warning: time was up .* \[time-limit\]/)
  const { refineEnd, timeLimitReached, refineRounds } = JSON.parse(fs.readFileSync(file, 'utf8'))
  assert.deepEqual({ refineEnd, timeLimitReached }, { refineEnd: 'time', timeLimitReached: true })
  assert.ok(refineRounds > 0 && seconds < 2 * limit, `${refineRounds} rounds, ${seconds} s`)
  await check_baked(input, target('timed.glb'))
})

test('without time for any light nothing is written', () => {
  assert_refused(4, /--time-limit: there is not enough time for any light/, test_asset('cornell_box.glb'), '--time-limit', '0.000001')
})
