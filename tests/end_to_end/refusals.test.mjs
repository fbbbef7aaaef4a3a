// Input that cannot be baked: exit 1, one line that names the place, and no file.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { run, temporary_folder, test_asset } from './command_line.mjs'
import { read_gltf, to_glb, view_bytes } from './gltf_file.mjs'

const folder = temporary_folder()

function write(name, bytes) {
  const file = path.join(folder, name)
  fs.writeFileSync(file, bytes)
  return file
}

// unit_cube.glb after `change`, which gets the JSON and the binary chunk.
function broken_cube(name, change) {
  const { json, buffers } = read_gltf(test_asset('unit_cube.glb'))
  const binary = Buffer.from(buffers[0])
  const changed = change(json, binary)
  return write(name, to_glb(changed ?? json, binary))
}

function broken_yard(name, change) {
  const { json } = read_gltf(test_asset('multi_buffer.gltf'))
  for (const uri of ['wall geometry.bin', 'ground.bin']) fs.copyFileSync(test_asset(uri), path.join(folder, uri))
  fs.mkdirSync(path.join(folder, 'textures'), { recursive: true })
  fs.copyFileSync(test_asset('textures/brick wall.png'), path.join(folder, 'textures/brick wall.png'))
  change(json)
  return write(name, JSON.stringify(json))
}

// Refused before the bake begins: nothing but the reason is printed.
function assert_refused(input, place, ...options) {
  const output = path.join(folder, 'refused.glb')
  const before = fs.readdirSync(folder)
  const { code, signal, stdout, lines, seconds } = run(input, output, '--progress', 'none', ...options)
  assert.deepEqual({ code, signal }, { code: 1, signal: null }, lines.join('\n'))
  assert.equal(stdout, '')
  assert.equal(lines.length, 1, lines.join('\n'))
  assert.match(lines[0], place)
  assert.deepEqual(fs.readdirSync(folder), before, 'nothing is written')
  assert.ok(seconds < 10, `took ${seconds} s`)
}

test('a file that is not there', () => assert_refused(path.join(folder, 'nowhere.glb'), /nowhere\.glb/))

test('a folder', () => assert_refused(folder, /\S/))

test('an empty file', () => assert_refused(write('empty.glb', ''), /\S/))

test('a file that is not glTF', () => {
  assert_refused(write('picture.glb', Buffer.from('\x89PNG\r\n\x1a\n....', 'latin1')), /\S/)
})

test('JSON that is not glTF', () => assert_refused(write('list.gltf', '[1, 2, 3]'), /\S/))

test('JSON that breaks off', () => assert_refused(broken_cube('json.glb', () => '{"asset":{"version":"2.0"},'), /\S/))

test('glTF 1.0', () => {
  assert_refused(broken_cube('one.glb', (json) => { json.asset.version = '1.0' }), /asset|version/)
})

for (const share of [0.01, 0.3, 0.6, 0.9, 0.99]) {
  test(`a GLB cut off after ${share * 100} % of its bytes`, () => {
    const bytes = fs.readFileSync(test_asset('cornell_box.glb'))
    assert_refused(write('cut.glb', bytes.subarray(0, Math.floor(bytes.length * share))), /\S/)
  })
}

test('a buffer that is not there', () => {
  assert_refused(broken_yard('buffer.gltf', (json) => { json.buffers[1].uri = 'gone.bin' }), /buffers\[1\]/)
})

test('a buffer that is shorter than it says', () => {
  assert_refused(broken_yard('short.gltf', (json) => { json.buffers[1].byteLength = 1e6 }), /buffers\[1\]/)
})

test('a buffer outside the folder of the file', () => {
  const uri = '../../../../etc/passwd'
  assert_refused(broken_yard('outside.gltf', (json) => { json.buffers[1].uri = uri }), /buffers\[1\]/)
})

test('an image that is not there', () => {
  assert_refused(broken_yard('image.gltf', (json) => { json.images[0].uri = 'gone.png' }), /images\[0\]/)
})

test('an accessor out of range', () => {
  const file = broken_cube('accessor.glb', (json) => { json.meshes[0].primitives[0].attributes.POSITION = 99 })
  assert_refused(file, /meshes\[0\]\.primitives\[0\]/)
})

test('an accessor longer than its buffer view', () => {
  assert_refused(broken_cube('long.glb', (json) => { json.accessors[0].count = 1e9 }), /accessors\[0\]/)
})

test('an accessor with more elements than 64 bits can count', () => {
  const huge = '"count":9223372036854775808'
  const file = broken_cube('huge.glb', (json) => JSON.stringify(json).replace('"count":24', huge))
  assert_refused(file, /accessors\[0\]/)
})

test('a mesh, a material, a child out of range', () => {
  assert_refused(broken_cube('mesh.glb', (json) => { json.nodes[0].mesh = 7 }), /nodes\[0\]/)
  assert_refused(broken_cube('material.glb', (json) => { json.meshes[0].primitives[0].material = -1 }), /meshes\[0\]/)
  assert_refused(broken_cube('child.glb', (json) => { json.nodes[0].children = [3] }), /nodes\[0\]/)
})

test('a node that is its own child', () => {
  assert_refused(broken_cube('cycle.glb', (json) => { json.nodes[0].children = [0] }), /nodes\[0\]/)
})

test('a vertex index out of range', () => {
  const file = broken_cube('index.glb', (json, binary) => {
    const { indices } = json.meshes[0].primitives[0]
    view_bytes({ json, buffers: [binary] }, json.accessors[indices].bufferView).writeUInt16LE(24, 6)
  })
  assert_refused(file, /meshes\[0\]\.primitives\[0\]|accessors\[\d+\]/)
})

for (const [name, value] of [['NaN', NaN], ['an infinite coordinate', Infinity]]) {
  test(`positions with ${name}`, () => {
    const file = broken_cube('position.glb', (json, binary) => {
      const { POSITION } = json.meshes[0].primitives[0].attributes
      view_bytes({ json, buffers: [binary] }, json.accessors[POSITION].bufferView).writeFloatLE(value, 16)
    })
    assert_refused(file, /meshes\[0\]\.primitives\[0\]|accessors\[\d+\]/)
  })
}

test('nothing to bake: no mesh, only points, only unlit', () => {
  const empty = { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ name: 'empty' }] }
  assert_refused(write('empty.gltf', JSON.stringify(empty)), /nothing to bake/)
  assert_refused(broken_cube('points.glb', (json) => { json.meshes[0].primitives[0].mode = 0 }), /nothing to bake/)
  const unlit = broken_cube('unlit.glb', (json) => {
    json.extensionsUsed = ['KHR_materials_unlit']
    json.materials[0].extensions = { KHR_materials_unlit: {} }
  })
  assert_refused(unlit, /nothing to bake/)
})

test('a required extension that is not supported', () => {
  const file = broken_cube('required.glb', (json) => {
    json.extensionsUsed = ['EXT_from_the_future']
    json.extensionsRequired = ['EXT_from_the_future']
  })
  assert_refused(file, /EXT_from_the_future/)
})

test('extras nested a hundred thousand deep', () => {
  const deep = '{"a":'.repeat(100_000) + '1' + '}'.repeat(100_000)
  const asset = `"asset":{"extras":${deep},`
  const file = broken_cube('deep.glb', (json) => JSON.stringify(json).replace('"asset":{', asset))
  assert_refused(file, /\S/)
})

test('compressed data that Draco cannot read', () => {
  const { json, buffers } = read_gltf(test_asset('draco_box.glb'))
  const binary = Buffer.from(buffers[0])
  binary.fill(0xff, 12)
  assert_refused(write('draco.glb', to_glb(json, binary)), /meshes\[0\]\.primitives\[0\]|bufferViews\[0\]/)
})

test('a sky that is not there, no HDR image, cut off, or too large', () => {
  const sunny = fs.readFileSync(test_asset('sunny.hdr'))
  const refuse = (sky, reason) => assert_refused(test_asset('unit_cube.glb'), reason, '--sky', sky)
  refuse(path.join(folder, 'gone.hdr'), /gone\.hdr: the file does not exist/)
  refuse(write('text.hdr', 'sky'), /text\.hdr: is not a Radiance HDR image/)
  refuse(write('cut.hdr', sunny.subarray(0, 5000)), /cut\.hdr: the HDR image is broken/)
  const huge = sunny.toString('latin1').replace('-Y 32 +X 64', '-Y 32 +X 20000')
  refuse(write('huge.hdr', Buffer.from(huge, 'latin1')), /huge\.hdr: the HDR image is larger/)
})

test('an image-based light that names an image out of range', () => {
  const { json, buffers } = read_gltf(test_asset('image_based_light.glb'))
  json.extensions.EXT_lights_image_based.lights[0].specularImages[0][2] = 7
  const file = write('light.glb', to_glb(json, Buffer.from(buffers[0])))
  assert_refused(file, /extensions\.EXT_lights_image_based\.lights\[0\]/)
})

test('an output file that was there stays when the input is refused', () => {
  const output = write('precious.glb', 'precious')
  assert.equal(run(write('bad.glb', 'bad'), output).code, 1)
  assert.equal(fs.readFileSync(output, 'utf8'), 'precious')
})
