// What becomes of an old output when the bake that would replace it fails: in malloc, in a call into the system, or by
// kill -9. It must be the old output or the new one, whole, whatever happens; and one line says why.
//
// The short form is part of the test suite. The long form takes every fault: GLTF_RADIOSITY_FAULTS=all, and as many
// kills as GLTF_RADIOSITY_KILLS says. The counts go to GLTF_RADIOSITY_FAULT_REPORT, if that is a file, as JSON lines.
import assert from 'node:assert/strict'
import { spawn, spawnSync } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, from_environment, program, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'

const every = process.env.GLTF_RADIOSITY_FAULTS === 'all'
const kill_count = Number(process.env.GLTF_RADIOSITY_KILLS ?? 12)
const tiny = ['--progress', 'none', '--refine', 'none', '--hemicube', 2, '--max-patches', 8, '--threads', 1, '--sky', '1,1,1']

function report(line) {
  const file = process.env.GLTF_RADIOSITY_FAULT_REPORT
  if (file) fs.appendFileSync(file, `${JSON.stringify(line)}\n`)
}

// Folders: the output as it was, as it will be, and where it is baked.
function stage(scene, output, ...options) {
  const folder = temporary_folder()
  const place = Object.fromEntries(['old', 'new', 'out'].map((name) => [name, path.join(folder, name)]))
  for (const name of Object.values(place)) fs.mkdirSync(name)
  bake(test_asset(scene), path.join(place.old, output), ...options, '--exposure', 0.5)
  bake(test_asset(scene), path.join(place.new, output), ...options, '--exposure', 1)
  const args = [test_asset(scene), path.join(place.out, output), ...options, '--exposure', 1].map(String)
  return { place, args }
}

// Runs the bake again and again, with another fault each time; answers what was counted.
function with_faults({ place, args }, kind, { first = 1, step = 1, runs = 1_000_000 } = {}) {
  const file = path.join(place.out, '..', `${kind}.json`)
  const env = {
    ...process.env, LD_PRELOAD: from_environment('GLTF_RADIOSITY_FAULT_LIBRARY'), FAULTS_KIND: kind, FAULTS_FIRST: first,
    FAULTS_STEP: step, FAULTS_RUNS: runs, FAULTS_FOLDER: place.out, FAULTS_OLD: place.old, FAULTS_NEW: place.new,
    FAULTS_REPORT: file,
  }
  const { status, stderr } = spawnSync(program(), args, { env, encoding: 'utf8' })
  assert.equal(status, 0, stderr)
  const counted = JSON.parse(fs.readFileSync(file, 'utf8'))
  report({ fault: kind, ...counted })
  assert.ok(counted.runs > 0, 'nothing has failed')
  assert.equal(counted.lost, 0, counted.examples)
  return counted
}

function assert_ends_well(counted, codes) {
  for (const ending of Object.keys(counted.endings)) assert.ok(codes.includes(ending), `${ending}: ${counted.examples}`)
  assert.equal(counted.wordy, 0, counted.examples)
}

const leftovers = (folder) => fs.readdirSync(folder).filter((name) => name.includes('.tmp-'))

for (const [kind, step] of [['allocation', 37], ['all-allocations', 61]]) {
  test(`${kind === 'allocation' ? 'an allocation that fails' : 'memory that runs out'} ends with one line and the old output`, () => {
    const staged = stage('unit_cube.glb', 'out.glb', ...tiny)
    const counted = with_faults(staged, kind, { step: every ? 1 : step })
    // Where no memory is needed any more, or what was asked for is optional, the bake succeeds all the same.
    assert_ends_well(counted, ['exit 0', 'exit 3', 'exit 4', 'exit 70'])
    assert.ok(counted.endings['exit 4'] > 0, JSON.stringify(counted))
  })
}

for (const kind of ['write', 'flush', 'open', 'rename']) {
  for (const output of ['out.glb', 'out.gltf']) {
    test(`${output}: ${kind === 'write' ? 'a full disk' : `no ${kind}`} is an error of writing and leaves nothing behind`, () => {
      const staged = stage('unit_cube.glb', output, ...tiny)
      const counted = with_faults(staged, kind)
      assert_ends_well(counted, ['exit 3'])
      assert.deepEqual(leftovers(staged.place.out), [])
    })
  }
}

for (const output of ['out.glb', 'out.gltf']) {
  test(`${output}: killed at any call that writes, the output is the old one or the new one`, () => {
    const staged = stage('unit_cube.glb', output, ...tiny)
    const counted = with_faults(staged, 'kill')
    assert.ok(counted.old > 0 && counted.new > 0, JSON.stringify(counted))
    assert.ok(leftovers(staged.place.out).length < 2, 'each run removes what the one before has left')
    bake(...staged.args)
    assert.deepEqual(leftovers(staged.place.out), [])
    assert.deepEqual(fs.readdirSync(staged.place.out).sort(), fs.readdirSync(staged.place.new).sort())
  })
}

test('short reads and interrupted ones change nothing', () => {
  const counted = with_faults(stage('multi_buffer.gltf', 'out.glb', ...tiny), 'read', { runs: 1 })
  assert_ends_well(counted, ['exit 0'])
  assert.equal(counted.new, 1)
})

test('a file that may not grow is an error of writing', () => {
  const { place, args } = stage('unit_cube.glb', 'out.glb', ...tiny)
  fs.cpSync(place.old, place.out, { recursive: true })
  const limited = ['-c', 'ulimit -f 1 && exec "$@"', 'sh', program(), ...args]
  const { status, stderr } = spawnSync('sh', limited, { encoding: 'utf8' })
  assert.equal(status, 3, stderr)
  assert.match(stderr, /^gltf-radiosity: error: .*out\.glb: cannot be written: File too large\n$/)
  assert.deepEqual(fs.readFileSync(path.join(place.out, 'out.glb')), fs.readFileSync(path.join(place.old, 'out.glb')))
  assert.deepEqual(leftovers(place.out), [])
})

// The same numbers every time (Steele, Vigna 2014: splitmix64, here of 32 bits).
function random_numbers(seed) {
  let state = seed
  return () => {
    state = (state + 0x9e3779b9) | 0
    let z = Math.imul(state ^ (state >>> 16), 0x85ebca6b)
    z = Math.imul(z ^ (z >>> 13), 0xc2b2ae35)
    return ((z ^ (z >>> 16)) >>> 0) / 2 ** 32
  }
}

test(`kill -9 at ${kill_count} random moments leaves the old output or the new one`, async () => {
  const { place, args } = stage('cornell_box.glb', 'out.gltf', ...tiny.slice(0, 4), '--quality', 'draft')
  const whole = (reference) => fs.readdirSync(reference).every((name) => {
    const file = path.join(place.out, name)
    return fs.existsSync(file) && fs.readFileSync(file).equals(fs.readFileSync(path.join(reference, name)))
  })
  const restore = () => {
    for (const name of fs.readdirSync(place.out)) if (!name.startsWith('.')) fs.rmSync(path.join(place.out, name))
    fs.cpSync(place.old, place.out, { recursive: true })
  }
  const run = (kill_after) => new Promise((resolve) => {
    const child = spawn(program(), args, { stdio: 'ignore' })
    const start = process.hrtime.bigint()
    const timer = kill_after === undefined ? undefined : setTimeout(() => child.kill('SIGKILL'), kill_after)
    child.on('exit', (code, signal) => {
      clearTimeout(timer)
      resolve({ code, signal, milliseconds: Number(process.hrtime.bigint() - start) / 1e6 })
    })
  })

  restore()
  const { milliseconds } = await run()
  const next = random_numbers(6)
  const counts = { runs: 0, killed: 0, old: 0, new: 0, lost: 0 }
  for (; counts.killed < kill_count && counts.runs < 4 * kill_count; ++counts.runs) {
    restore()
    const { signal } = await run(next() * milliseconds)
    if (signal === 'SIGKILL') ++counts.killed
    ++counts[whole(place.new) ? 'new' : whole(place.old) ? 'old' : 'lost']
  }
  report({ fault: 'kill at random', ...counts })
  assert.equal(counts.lost, 0, JSON.stringify(counts))
  assert.equal(counts.killed, kill_count, JSON.stringify(counts))
  await run()
  assert.deepEqual(fs.readdirSync(place.out).sort(), fs.readdirSync(place.new).sort(), 'nothing is left of them')
})
