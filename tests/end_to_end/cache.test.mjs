// Results kept from one bake to the next: --cache.
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, cheapest, program, run, temporary_folder, test_asset } from './command_line.mjs'
import { read_gltf, to_glb } from './gltf_file.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)
const entries = (cache) => fs.readdirSync(cache).sort()
const bytes = (file) => fs.readFileSync(file)
const quick = [...cheapest, '--max-vertices', 1000]
const scene = test_asset('cornell_box.glb')

// A copy of a scene with its JSON changed.
function changed(name, input, change) {
  const { json, buffers } = read_gltf(input)
  change(json)
  fs.writeFileSync(target(name), to_glb(json, buffers[0]))
  return target(name)
}

test('a second bake is read from the cache, with the same bytes and the same report', () => {
  for (const [name, options] of [['cornell_box', []], ['textured_interior', ['--refine', 'none']], ['sky_court', ['--sky', test_asset('sunny.hdr')]]]) {
    const cache = target(`cache of ${name}`)
    const input = test_asset(`${name}.glb`)
    const reports = [[], ['--cache', cache], ['--cache', cache]].map((cached, i) =>
      bake(input, target(`${name} ${i}.glb`), ...quick, ...options, ...cached))
    assert.deepEqual(reports.map((report) => report.cache), ['', 'nothing', 'bake'])
    for (const i of [1, 2]) {
      assert.ok(bytes(target(`${name} ${i}.glb`)).equals(bytes(target(`${name} 0.glb`))), `${name}: run ${i}`)
      const { phases: p, cache: c, ...report } = reports[i]
      const { phases: q, cache: d, ...expected } = reports[0]
      assert.deepEqual(report, expected)
    }
    assert.equal(entries(cache).length, 2)
  }
})

test('neither threads nor names nor the style of the output matter', () => {
  const cache = target('names')
  bake(scene, target('first.glb'), ...quick, '--cache', cache)
  fs.copyFileSync(scene, target('renamed.glb'))
  const options = ['--threads', 1, '--color-type', 'u16', '--max-memory', '1G']
  assert.equal(bake(target('renamed.glb'), target('u16.gltf'), ...quick, ...options, '--cache', cache).cache, 'bake')
})

test('an option that matters is another bake', () => {
  const cache = target('options')
  bake(scene, target('a.glb'), ...quick, '--cache', cache)
  for (const option of [['--max-vertices', 900], ['--bake', 'direct'], ['--residual', '0.04'], ['--sky', '1,1,1'], ['--sun', '45,0,1'], ['--max-error', '0.5'], ['--metals', 'black'], ['--exposure', '2']]) {
    assert.notEqual(bake(scene, target('b.glb'), ...quick, ...option, '--cache', cache).cache, 'bake', option.join(' '))
  }
})

test('other reflectances and other lights find the form factors', () => {
  const cache = target('materials')
  const fixed = [...cheapest, '--refine', 'none', '--cache', cache]
  bake(scene, target('before.glb'), ...fixed)
  const darker = changed('darker.glb', scene, (json) => json.materials.forEach(({ pbrMetallicRoughness: pbr }) => {
    if (pbr?.baseColorFactor) pbr.baseColorFactor = [0.3, 0.2, 0.1, 1]
  }))
  const brighter = changed('brighter.glb', scene, (json) => json.materials.forEach((material) => {
    if (material.emissiveFactor) material.emissiveFactor = material.emissiveFactor.map((x) => x / 2)
  }))
  for (const input of [darker, brighter]) {
    const report = bake(input, target('with.glb'), ...fixed)
    assert.equal(report.cache, 'form-factors')
    bake(input, target('without.glb'), ...cheapest, '--refine', 'none')
    assert.ok(bytes(target('with.glb')).equals(bytes(target('without.glb'))))
  }
})

test('moved geometry finds nothing', () => {
  const cache = target('moved')
  bake(scene, target('before.glb'), ...quick, '--cache', cache)
  const moved = changed('moved.glb', scene, (json) => { json.nodes.find(({ mesh }) => mesh !== undefined).scale = [1.01, 1.01, 1.01] })
  assert.equal(bake(moved, target('after.glb'), ...quick, '--cache', cache).cache, 'nothing')
})

test('a damaged entry is a warning and is computed again', () => {
  const cache = target('damaged')
  bake(scene, target('before.glb'), ...quick, '--cache', cache)
  for (const name of entries(cache)) {
    const content = bytes(path.join(cache, name))
    content[Math.floor(content.length / 2)] ^= 1
    fs.writeFileSync(path.join(cache, name), content)
  }
  const report = bake(scene, target('after.glb'), ...quick, '--cache', cache)
  assert.equal(report.cache, 'nothing')
  assert.deepEqual(report.warnings.map(({ code }) => code).filter((code) => code === 'cache-damaged').length, 2)
  assert.ok(bytes(target('after.glb')).equals(bytes(target('before.glb'))))
  assert.equal(bake(scene, target('after.glb'), ...quick, '--cache', cache).cache, 'bake')
})

test('a folder that cannot be used ends with 3, before anything is baked', () => {
  fs.writeFileSync(target('file'), '')
  const { code, lines } = run(scene, target('x.glb'), '--cache', target('file'), '--progress', 'none', ...quick)
  assert.equal(code, 3)
  assert.equal(lines.length, 1, lines.join('\n'))
  assert.ok(!fs.existsSync(target('x.glb')))
})

test('an interrupted bake leaves its form factors, and the next one goes on from them', async () => {
  const cache = target('resumed')
  const long = ['--max-patches', 500, '--hemicube', 64, '--refine', 'uniform', '--patch-size', '0.005', '--cache', cache]
  const child = spawn(program(), [scene, target('x.glb'), ...long].map(String), { stdio: ['ignore', 'ignore', 'pipe'] })
  const ended = new Promise((resolve) => child.on('exit', resolve))
  await new Promise((resolve) => child.stderr.on('data', (text) => { if (String(text).includes('gather')) resolve() }))
  child.kill('SIGINT')
  assert.equal(await ended, 130)
  assert.deepEqual(entries(cache).map((name) => name.replace(/-[0-9a-f]+\./, '.')), ['rows.radcache'])
})

test('many processes share a cache', async () => {
  const cache = target('shared')
  bake(scene, target('alone.glb'), ...quick)
  const crowd = [...Array(4).keys()].map((i) => new Promise((resolve) => {
    const args = [scene, target(`crowd ${i}.glb`), '--cache', cache, '--progress', 'none', ...quick]
    spawn(program(), args.map(String), { stdio: ['ignore', 'ignore', 'inherit'] }).on('exit', resolve)
  }))
  assert.deepEqual(await Promise.all(crowd), crowd.map(() => 0))
  for (const i of crowd.keys()) assert.ok(bytes(target(`crowd ${i}.glb`)).equals(bytes(target('alone.glb'))))
  assert.equal(entries(cache).length, 2)
})
