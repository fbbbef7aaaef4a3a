// The promises of the command line: exit codes, silence, reports, and the same bytes for any number of threads.
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { check_baked, colors_of } from './baked.mjs'
import { bake, program, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { primitives_of_scene, read_gltf } from './gltf_file.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)
const reds_of = (gltf) =>
  primitives_of_scene(gltf).flatMap(([, primitive]) => colors_of(gltf, primitive).map(([red]) => red))
const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length

const thread_counts = sanitized() ? [1, 7] : [1, 2, 7]

function assert_threads_do_not_matter(scene, ...options) {
  const output = target(`${scene}.glb`)
  const [one, ...others] = thread_counts.map((threads) => {
    bake(test_asset(`${scene}.glb`), output, '--quality', 'draft', '--threads', threads, ...options)
    return fs.readFileSync(output)
  })
  others.forEach((other, k) => assert.ok(other.equals(one), `${thread_counts[k + 1]} threads differ from 1`))
}

for (const scene of ['cornell_box', 'textured_interior', 'lights_all_kinds']) {
  test(`${scene} bakes to the same bytes with ${thread_counts} threads`, () => assert_threads_do_not_matter(scene))
}

test('a scene without any light gets a white sky and a warning', async () => {
  const output = target('sky.glb')
  const { code, stdout, stderr } = run(test_asset('unit_cube.glb'), output)
  assert.equal(code, 0, stderr)
  assert.equal(stdout, '')
  assert.match(stderr, /warning: .*sky/)
  const baked = await check_baked(test_asset('unit_cube.glb'), output)
  const [[, cube]] = primitives_of_scene(baked.output)
  for (const [red] of colors_of(baked.output, cube)) assert.ok(red > 0.4 && red <= 1, `a vertex shows ${red}`)
})

test('--no-default-sky bakes black', () => {
  const output = target('black.glb')
  bake(test_asset('unit_cube.glb'), output, '--no-default-sky')
  const gltf = read_gltf(output)
  const [[, cube]] = primitives_of_scene(gltf)
  for (const color of colors_of(gltf, cube)) assert.deepEqual(color, [0, 0, 0, 1])
})

test('--sky and --sun light a scene, which then needs no default sky', () => {
  const light = ['--sky', '0.1,0.2,0.4', '--sun', '60,30,2']
  const report = bake(test_asset('sky_court.glb'), target('sun.glb'), '--quality', 'draft', ...light)
  assert.ok(report.warnings.every(({ code }) => code !== 'default-sky'))
  const gltf = read_gltf(target('sun.glb'))
  assert.ok(mean(reds_of(gltf)) > 0.1)
})

test('--sky replaces the sky of the file and says so; the file itself keeps it', () => {
  const output = target('replaced.glb')
  const report = bake(test_asset('image_based_light.glb'), output, '--sky', test_asset('sunny.hdr'))
  assert.deepEqual(report.warnings.map(({ code }) => code), ['image-based-light-replaced'])
  const input = read_gltf(test_asset('image_based_light.glb'))
  assert.deepEqual(read_gltf(output).json.extensions, input.json.extensions)
  assert.deepEqual(bake(test_asset('image_based_light.glb'), output).warnings, [])
})

test(`a court under an HDR sky bakes to the same bytes with ${thread_counts} threads`, () => {
  assert_threads_do_not_matter('sky_court', '--sky', test_asset('sunny.hdr'))
})

test('--exposure scales the colours and is written into the file', () => {
  const colors = [0.25, 0.5].map((exposure) => {
    const output = target(`exposure_${exposure}.glb`)
    const report = bake(test_asset('occluder.glb'), output, '--refine', 'none', '--exposure', exposure)
    assert.equal(report.exposure, exposure)
    const gltf = read_gltf(output)
    assert.equal(gltf.json.asset.extras.radiosity.exposure, exposure)
    return mean(reds_of(gltf))
  })
  assert.ok(Math.abs(colors[1] / colors[0] - 2) < 1e-3, `means ${colors}`)
})

test('the report accounts for the light: what was emitted was absorbed or escaped', () => {
  for (const scene of ['cornell_box', 'white_furnace_50', 'draco_box']) {
    const report = bake(test_asset(`${scene}.glb`), target('balance.glb'), '--refine', 'none')
    const { emittedFlux, absorbedFlux, escapedFlux, residual, closureError, reciprocityError, glowShare } = report
    assert.ok(closureError < 1e-5 && reciprocityError < 0.1 && glowShare === 0, `${scene}: ${JSON.stringify(report)}`)
    const lost = Math.abs(emittedFlux - absorbedFlux - escapedFlux)
    assert.ok(emittedFlux > 0 && lost <= (residual + 0.02) * emittedFlux, `${scene}: ${JSON.stringify(report)}`)
  }
})

test('the report names counts, phases and the exposure, and goes to a file or to stdout', () => {
  const file = target('report.json')
  assert.equal(run(test_asset('cornell_box.glb'), target('report.glb'), '--quality', 'draft', '--json', file).code, 0)
  const report = JSON.parse(fs.readFileSync(file, 'utf8'))
  assert.equal(report.inputTriangles, 32)
  assert.ok(report.outputTriangles >= 32 && report.patches > 0 && report.exposure > 0)
  assert.ok(report.phases.length >= 4 && report.phases.every(({ seconds }) => seconds >= 0))
})

test('progress is plain lines where there is no terminal, and stdout stays empty', () => {
  const input = test_asset('cornell_box.glb')
  const { code, stdout, stderr, lines } = run(input, target('progress.glb'), '--quality', 'draft')
  assert.equal(code, 0)
  assert.equal(stdout, '')
  assert.ok(lines.length > 2, stderr)
  assert.ok(!/[\r\x1b]/.test(stderr), 'no control characters')
})

test('usage that is wrong ends with 2 and one line', () => {
  const cube = test_asset('unit_cube.glb')
  const wrong = [
    [],
    [cube],
    ...[['--no-such-option'], ['--refine', 'maybe'], ['--sky', '1,1'], ['--hemicube', '3'], ['--threads', 'nan']]
      .map((options) => [cube, target('x.glb'), ...options]),
  ]
  for (const args of wrong) {
    const { code, stdout, lines } = run(...args)
    assert.equal(code, 2, args.join(' '))
    assert.equal(stdout, '')
    assert.equal(lines.length, 1, lines.join('\n'))
  }
  assert.ok(!fs.existsSync(target('x.glb')))
})

test('--help and --version answer on stdout', () => {
  for (const option of ['--help', '--version']) {
    const { code, stdout, stderr } = run(option)
    assert.equal(code, 0)
    assert.equal(stderr, '')
    assert.match(stdout, /gltf-radiosity/)
  }
})

test('an output that cannot be written ends with 3', () => {
  for (const output of [target('no/such/folder/out.glb'), '/dev/full/out.glb']) {
    const { code, lines } = run(test_asset('unit_cube.glb'), output, '--progress', 'none', '--sky', '1,1,1')
    assert.equal(code, 3, lines.join('\n'))
    assert.equal(lines.length, 1, lines.join('\n'))
  }
})

test('a bake goes on when nobody reads its progress any more, and says when nobody reads its report', async () => {
  for (const [options, stream, expected] of [[['--progress', 'plain'], 'stderr', 0], [['--json', '-'], 'stdout', 3]]) {
    const output = target('unread.glb')
    fs.rmSync(output, { force: true })
    const child = spawn(program(), [test_asset('cornell_box.glb'), output, '--quality', 'draft', ...options])
    child[stream].destroy()
    const ending = await new Promise((resolve) => child.on('exit', (code, signal) => resolve(code ?? signal)))
    assert.equal(ending, expected, stream)
    await check_baked(test_asset('cornell_box.glb'), output)
  }
})

test('an interrupted bake stops soon, says so by its exit code, and leaves the old file', async () => {
  const output = target('old.glb')
  fs.writeFileSync(output, 'old')
  const options = ['--patch-size', '0.004', '--hemicube', '128']
  const stdio = ['ignore', 'ignore', 'pipe']
  const child = spawn(program(), [test_asset('cornell_box.glb'), output, ...options], { stdio })
  const ended = new Promise((resolve) => child.on('exit', (code, signal) => resolve({ code, signal })))
  await new Promise((resolve) => child.stderr.once('data', resolve))
  const start = Date.now()
  child.kill('SIGINT')
  const { code, signal } = await ended
  assert.ok(code === 130 || signal === 'SIGINT', `exit ${code ?? signal}`)
  assert.ok(Date.now() - start < (sanitized() ? 20_000 : 5_000), `${Date.now() - start} ms to stop`)
  assert.equal(fs.readFileSync(output, 'utf8'), 'old')
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.startsWith('old.glb')), ['old.glb'])
})
