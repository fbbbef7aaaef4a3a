// Files from elsewhere: each bakes without a new validator error, or is refused with one sentence. None crashes.
//
// They are not part of the project. GLTF_RADIOSITY_ASSETS names their folder; CTest reports the test as skipped
// without it.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { check_baked } from './baked.mjs'
import { cheapest, run, run_within, sanitized, temporary_folder } from './command_line.mjs'

const assets = process.env.GLTF_RADIOSITY_ASSETS ?? ''
const folder = temporary_folder()
const files_in = (...names) => {
  const place = path.join(assets, ...names)
  const found = fs.existsSync(place) ? fs.readdirSync(place).sort() : []
  return found.filter((name) => /\.(glb|gltf)$/.test(name)).map((name) => path.join(place, name))
}

// Under sanitizers: what is small, which is what has odd features.
const is_small = (file) => !sanitized() || fs.statSync(file).size < 100_000
const to_bake = ['interior', 'objects', 'features'].flatMap((name) => files_in(name)).filter(is_small)
const malformed = [...files_in('malformed'), ...files_in('malformed', 'as_glb')]
const options = [...cheapest, '--refine', 'none']

if (to_bake.length + malformed.length === 0) {
  console.log(`SKIPPED: no assets in '${assets}' (0 files); GLTF_RADIOSITY_ASSETS names the folder that holds them`)
}

const relative = (file) => path.relative(assets, file)

// Exit 1 with one line that says why.
function assert_refused({ code, signal, lines, stdout }, output) {
  assert.deepEqual({ code, signal }, { code: 1, signal: null }, lines.join('\n'))
  assert.equal(stdout, '')
  assert.equal(lines.length, 1, lines.join('\n'))
  assert.ok(!fs.existsSync(output), 'nothing is written')
}

for (const file of to_bake) {
  test(`${relative(file)} bakes, or is refused with a sentence`, async (t) => {
    const output = path.join(folder, 'baked.glb')
    fs.rmSync(output, { force: true })
    const result = run(file, output, '--progress', 'none', ...options)
    t.diagnostic(`exit ${result.code} after ${result.seconds.toFixed(1)} s: ${result.lines.join(' | ').slice(0, 300)}`)
    if (result.code === 0) await check_baked(file, output)
    else assert_refused(result, output)
  })
}

for (const file of malformed) {
  test(`${relative(file)} does no harm`, async () => {
    const output = path.join(folder, 'harmless.glb')
    fs.rmSync(output, { force: true })
    const result = run_within(256, file, output, '--progress', 'none', '--threads', 2, ...options)
    assert.ok(result.seconds < (sanitized() ? 20 : 1), `took ${result.seconds} s`)
    if (result.code === 0) await check_baked(file, output)
    else assert_refused(result, output)
  })
}
