// Where files come from and where they go: nothing is read that was not given, nothing replaced that was not asked for.
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, cheapest, program, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { read_gltf } from './gltf_file.mjs'

const cheap = [...cheapest, '--refine', 'none', '--progress', 'none']

// A folder with the yard: a .gltf, two .bin files and a picture.
function yard() {
  const folder = temporary_folder()
  for (const name of ['multi_buffer.gltf', 'wall geometry.bin', 'ground.bin', 'textures/brick wall.png']) {
    fs.mkdirSync(path.dirname(path.join(folder, name)), { recursive: true })
    fs.copyFileSync(test_asset(name), path.join(folder, name))
  }
  return (name) => path.join(folder, name)
}

const snapshot = (folder) =>
  fs.readdirSync(folder, { recursive: true }).sort().filter((name) => fs.statSync(path.join(folder, name)).isFile())
    .map((name) => [name, fs.readFileSync(path.join(folder, name)).toString('base64')])

function assert_refused(code, place, input, output, ...options) {
  const before = snapshot(path.dirname(input))
  const result = run(input, output, ...cheap, ...options)
  assert.equal(result.code, code, result.stderr)
  assert.equal(result.lines.length, 1, result.stderr)
  assert.match(result.lines[0], place)
  assert.deepEqual(snapshot(path.dirname(input)), before, 'nothing has changed')
}

test('the output replaces the input only by force, whatever it is called', () => {
  const file = yard()
  const input = file('multi_buffer.gltf')
  fs.symlinkSync('multi_buffer.gltf', file('symbolic.gltf'))
  fs.linkSync(input, file('hard.gltf'))
  for (const output of [input, file('./textures/../multi_buffer.gltf'), file('symbolic.gltf'), file('hard.gltf')]) {
    assert_refused(2, /would replace the input/, input, output)
  }
  bake(input, input, ...cheap, '--force')
  assert.ok(read_gltf(input).json.asset.extras.radiosity, 'it is baked')
})

test('neither the output nor the report replaces a buffer or an image of the input', () => {
  const file = yard()
  const input = file('multi_buffer.gltf')
  fs.linkSync(file('ground.bin'), file('linked.glb'))
  assert_refused(2, /linked\.glb: would replace/, input, file('linked.glb'))
  assert_refused(2, /ground\.bin: would replace/, input, file('out.glb'), '--json', file('ground.bin'))
  assert_refused(2, /brick wall\.png: would replace/, input, file('out.glb'), '--json', file('textures/brick wall.png'))
})

test('a report does not replace a buffer of an input that is refused', () => {
  const file = yard()
  const input = file('multi_buffer.gltf')
  fs.rmSync(file('wall geometry.bin'))
  assert_refused(2, /ground\.bin: would replace/, input, file('out.glb'), '--json', file('ground.bin'))
})

test('verify writes neither its report nor its picture over a file of the scenes', () => {
  const file = yard()
  const input = file('multi_buffer.gltf')
  bake(input, file('out.glb'), ...cheap)
  const before = snapshot(file('.'))
  for (const options of [['--json', file('ground.bin')], ['--image', file('textures/brick wall.png')]]) {
    const { code, stderr } = run('verify', input, file('out.glb'), '--points', 10, '--progress', 'none', ...options)
    assert.equal(code, 2, stderr)
    assert.match(stderr, /would replace/)
  }
  assert.deepEqual(snapshot(file('.')), before)
})

test('buffers and images outside the folder are read only if that is allowed', () => {
  const file = yard()
  const input = file('inside/scene.gltf')
  const json = JSON.parse(fs.readFileSync(file('multi_buffer.gltf'), 'utf8'))
  for (const { uri } of json.buffers) assert.ok(fs.existsSync(file(decodeURIComponent(uri))))
  for (const owner of [...json.buffers, ...json.images]) owner.uri = `../${owner.uri}`
  fs.mkdirSync(file('inside'))
  fs.writeFileSync(input, JSON.stringify(json))
  assert_refused(1, /buffers\[0\]: .* lies outside the glTF's folder/, input, file('out.glb'))
  bake(input, file('out.glb'), ...cheap, '--allow-outside')
  bake(input, file('out.gltf'), ...cheap, '--allow-outside')
  const { json: baked } = read_gltf(file('out.gltf'))
  assert.match(baked.images[0].uri, /^(textures\/brick%20wall|brick%20wall-[0-9a-f]{16})\.png$/)
})

test('a .gltf that is baked again has one .bin, and so has the other one in the folder', () => {
  const file = yard()
  const input = file('multi_buffer.gltf')
  const bins = () => fs.readdirSync(file('out')).filter((name) => name.endsWith('.bin')).sort()
  fs.mkdirSync(file('out'))
  bake(input, file('out/a.gltf'), ...cheap)
  bake(input, file('out/b.gltf'), ...cheap, '--exposure', 0.7)
  const [a, b] = bins()
  assert.match(a, /^a-[0-9a-f]{16}\.bin$/)
  fs.copyFileSync(file('out/b.gltf'), file('out/kept.gltf'))
  bake(input, file('out/a.gltf'), ...cheap, '--exposure', 0.5)
  bake(input, file('out/b.gltf'), ...cheap, '--exposure', 0.5)
  assert.equal(bins().length, 3, bins().join())
  assert.ok(!bins().includes(a), 'nothing needs it')
  assert.ok(bins().includes(b), 'kept.gltf needs it')
  for (const name of ['a', 'b', 'kept']) read_gltf(file(`out/${name}.gltf`))
})

test('what a killed bake has left is gone after the next one, what is at work elsewhere stays', () => {
  const file = yard()
  fs.writeFileSync(file('.out.glb.tmp-12345-0'), 'half of it')
  fs.writeFileSync(file('.other.glb.tmp-12345-0'), 'of another output')
  bake(file('multi_buffer.gltf'), file('out.glb'), ...cheap)
  assert.deepEqual(fs.readdirSync(file('.')).filter((name) => name.startsWith('.')), ['.other.glb.tmp-12345-0'])
})

for (const [name, code] of [['SIGINT', 130], ['SIGTERM', 143]]) {
  test(`${name} ends what cannot be asked to stop within a second, with a report`, async () => {
    // The largest hemicubes: a batch of rows takes seconds.
    const file = yard()
    fs.writeFileSync(file('old.glb'), 'old')
    const options = ['--hemicube', '512', '--visibility', 'raster', '--json', file('report.json')]
    const stdio = ['ignore', 'ignore', 'pipe']
    const child = spawn(program(), [test_asset('cornell_box.glb'), file('old.glb'), ...options], { stdio })
    let text = ''
    const solving = new Promise((resolve) => child.stderr.on('data', (data) => { if ((text += data).includes('solve')) resolve() }))
    const ended = new Promise((resolve) => child.on('close', (code, signal) => resolve({ code, signal })))
    await Promise.race([solving, ended])
    const start = Date.now()
    child.kill(name)
    assert.deepEqual(await ended, { code, signal: null }, text)
    assert.ok(Date.now() - start < (sanitized() ? 10_000 : 2_000), `${Date.now() - start} ms to stop`)
    assert.equal(fs.readFileSync(file('old.glb'), 'utf8'), 'old')
    assert.equal(JSON.parse(fs.readFileSync(file('report.json'), 'utf8')).error.code, 'cancelled')
    assert.match(text, /gltf-radiosity: error: cancelled\n$/)
  })
}
