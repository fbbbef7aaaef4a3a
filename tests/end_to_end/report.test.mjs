// Reports are as docs/report.schema.json has them, and docs/report.md knows every code. The reports of all other bakes are
// checked too: bake() in command_line.mjs does.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, cheapest, run, temporary_folder, test_asset } from './command_line.mjs'
import { valid_report, wrong_with_report } from './report_schema.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)
const root = new URL('../../', import.meta.url).pathname
const read = (file) => fs.readFileSync(path.join(root, file), 'utf8')
const text_of = (directory) => fs.readdirSync(path.join(root, directory)).filter((name) => /\.(cpp|h)$/.test(name))
  .map((name) => read(path.join(directory, name))).join('\n')
// The codes in the first column of a table of docs/report.md.
const listed_codes = (heading) => [...read('docs/report.md').split(`## ${heading}\n`)[1].split('\n## ')[0]
  .matchAll(/^\| `([^`]+)` \|/gm)].map(([, code]) => code)

test('a bake with everything that changes a report is as the schema has it', () => {
  const options = ['--simplify', '--meshopt', '--engine', 'godot', '--bake', 'indirect', '--solver', 'progressive']
  const report = bake(test_asset('cornell_box.glb'), target('all.glb'), ...cheapest, ...options)
  assert.ok(report.warnings.some(({ code }) => code === 'engine-cannot-read'))
  assert.deepEqual(wrong_with_report(report), [])
})

test('a failure is as the schema has it, for every code that a file can cause', () => {
  const bad = target('bad.glb')
  fs.writeFileSync(bad, 'no glTF at all')
  const cube = test_asset('unit_cube.glb')
  const failures = [
    ['bad-input', 1, [bad, target('x.glb')]],
    ['bad-input', 1, [target('no_such.glb'), target('x.glb')]],
    ['bad-option', 2, [cube, target('x.obj')]],
    ['cannot-write', 3, [cube, target('no/folder/x.glb')]],
    ['bad-input', 1, ['verify', cube, cube]],
  ]
  for (const [error_code, exit_code, args] of failures) {
    const { code, stdout } = run(...args, '--json', '-', '--progress', 'none')
    assert.equal(code, exit_code, args.join(' '))
    assert.equal(valid_report(stdout, 'failure').error.code, error_code)
    assert.deepEqual(wrong_with_report(JSON.parse(stdout)), [])
  }
})

test('a verification is as the schema has it', () => {
  const baked = target('verified.glb')
  bake(test_asset('occluder.glb'), baked, ...cheapest)
  const { code, stdout, stderr } = run('verify', test_asset('occluder.glb'), baked, '--points', 50, '--max-samples', 64,
    '--progress', 'none', '--json', '-')
  assert.equal(code, 0, stderr)
  assert.deepEqual(wrong_with_report(valid_report(stdout, 'verify')), [])
})

test('warnings name a code that docs/report.md lists, and a place in the file', () => {
  const seen = new Set()
  const scenes = ['torture.gltf', 'points_and_lines.glb', 'skinned_and_morphed.glb', 'extras_everywhere.glb', 'unit_cube.glb']
  for (const scene of scenes) {
    const { warnings } = bake(test_asset(scene), target('warned.glb'), ...cheapest, '--refine', 'none')
    for (const { code, place } of warnings) {
      seen.add(code)
      assert.ok(listed_codes('Warnings').includes(code), `${code} of ${scene} is not in docs/report.md`)
      assert.match(place, /^$|^(nodes|meshes|materials|images|textures|extensions|scenes)\[\d+\]/, `${code} of ${scene}`)
    }
  }
  assert.ok(seen.size > 2, [...seen].join(' '))
})

test('a report that lacks or adds something is seen', () => {
  const report = bake(test_asset('unit_cube.glb'), target('cube.glb'), ...cheapest, '--refine', 'none')
  const { exposure, ...without } = report
  assert.notDeepEqual(wrong_with_report(without), [])
  assert.notDeepEqual(wrong_with_report({ ...report, more: 1 }), [])
  assert.notDeepEqual(wrong_with_report({ ...report, patches: -1 }), [])
  assert.notDeepEqual(wrong_with_report({ ...report, warnings: [{ code: 'no code', place: '', message: 'x' }] }), [])
})

test('docs/report.md lists the codes of all warnings in the sources, and no other', () => {
  const in_sources = [...text_of('plugin').matchAll(/"([a-z0-9]+(?:-[a-z0-9]+)+)",/g)].map(([, code]) => code)
  assert.ok(in_sources.length > 20)
  assert.deepEqual(listed_codes('Warnings'), [...new Set(in_sources)].sort())
})

test('docs/report.md lists the codes of all errors in the sources, and no other; so does the schema', () => {
  const function_text = /std::string_view code_of\(ErrorCode[^]*?\n}\n/.exec(read('tools/report_file.cpp'))[0]
  const in_sources = [...new Set([...function_text.matchAll(/return "([a-z-]+)"/g)].map(([, code]) => code))]
  assert.deepEqual(listed_codes('Errors').sort(), [...in_sources].sort())
  const schema = JSON.parse(read('docs/report.schema.json'))
  assert.deepEqual([...schema.$defs.failure.properties.error.properties.code.enum].sort(), [...in_sources].sort())
})
