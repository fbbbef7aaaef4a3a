// Many files in one go: --batch.
import assert from 'node:assert/strict'
import { spawn, spawnSync } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, cheapest, program, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { valid_report, wrong_with_report } from './report_schema.mjs'

const folder = temporary_folder()
const quick = [...cheapest, '--refine', 'none']
// Minutes of work that can be interrupted.
const endless = ['--patch-size', '0.003', '--hemicube', '256', '--refine', 'uniform']

// A folder with these files; a value is the name of a test scene, or text.
function make_folder(name, files) {
  for (const [file, content] of Object.entries(files)) {
    const target = path.join(folder, name, file)
    fs.mkdirSync(path.dirname(target), { recursive: true })
    if (/\.(glb|gltf)$/.test(content)) fs.copyFileSync(test_asset(content), target)
    else fs.writeFileSync(target, content)
  }
  return path.join(folder, name)
}

const files_in = (top) => fs.readdirSync(top, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile())
  .map((entry) => path.relative(top, path.join(entry.parentPath ?? entry.path, entry.name))).sort()
const report_of = (file) => valid_report(fs.readFileSync(file, 'utf8'), 'batch')
const exit_codes = ({ files }) => files.map(({ exitCode }) => exitCode)

test('a folder is baked with all below it, each file to the same bytes as by itself', () => {
  const input = make_folder('tree', { 'a.glb': 'unit_cube.glb', 'rooms/b.glb': 'occluder.glb', 'rooms/deep/c.GLB': 'draco_box.glb', 'rooms/notes.txt': 'no scene' })
  const output = path.join(folder, 'tree baked')
  for (const jobs of [1, 3]) {
    const json = path.join(folder, `tree ${jobs}.json`)
    const { code, stdout, stderr } = run('--batch', input, output, '--jobs', jobs, '--json', json, ...quick)
    assert.equal(code, 0, stderr)
    assert.equal(stdout, '')
    const baked = ['a.glb', 'rooms/b.glb', 'rooms/deep/c.GLB']
    assert.deepEqual(files_in(output), baked)
    for (const file of baked) {
      const alone = path.join(folder, 'alone.glb')
      bake(path.join(input, file), alone, ...quick)
      assert.ok(fs.readFileSync(path.join(output, file)).equals(fs.readFileSync(alone)), file)
    }
    const report = report_of(json)
    assert.deepEqual(wrong_with_report(report), [])
    assert.deepEqual(report.files.map((file) => [path.relative(input, file.input), path.relative(output, file.output), file.exitCode]),
      baked.map((file) => [file, file, 0]))
    assert.equal(report.totals.jobs, jobs)
  }
})

test('a bad file does not stop the batch: a line for each, a table, and the exit code of the worst', () => {
  const input = make_folder('mixed', { '1.glb': 'no glTF', '2.glb': 'unit_cube.glb', '3.gltf': '{', '4.glb': 'occluder.glb' })
  const json = path.join(folder, 'mixed.json')
  const { code, lines } = run('--batch', input, path.join(folder, 'mixed baked'), '--jobs', 2, '--json', json, ...quick)
  assert.equal(code, 1)
  assert.equal(lines.filter((line) => /^gltf-radiosity: \[[1-4]\/4\] /.test(line)).length, 4, lines.join('\n'))
  assert.deepEqual(lines.slice(5, 9).map((line) => line.slice(0, 6)), ['exit 1', 'done  ', 'exit 1', 'done  '], lines.join('\n'))
  assert.match(lines.at(-1), /^gltf-radiosity: batch: 2 of 4 files baked, 2 failed, 0 not started, /)
  assert.deepEqual(files_in(path.join(folder, 'mixed baked')), ['2.glb', '4.glb'])
  const report = report_of(json)
  assert.deepEqual(exit_codes(report), [1, 0, 1, 0])
  assert.equal(report.exitCode, 1)
  assert.equal(report.files[0].report.error.code, 'bad-input')
})

test('--progress none says only what failed', () => {
  const { lines } = run('--batch', path.join(folder, 'mixed'), path.join(folder, 'mixed baked'), '--progress', 'none', ...quick)
  assert.equal(lines.length, 2, lines.join('\n'))
  assert.ok(lines.every((line) => line.includes('.gl') && line.includes('error: ')), lines.join('\n'))
})

test('what lies in OUT_DIR is not baked again', () => {
  const input = make_folder('inside', { 'a.glb': 'unit_cube.glb' })
  for (let i = 0; i < 2; ++i) {
    assert.equal(run('--batch', input, path.join(input, 'baked'), ...quick).code, 0)
    assert.deepEqual(files_in(input), ['a.glb', 'baked/a.glb'])
  }
})

test('a list of paths, from a file or from standard input, keeps relative folders', () => {
  const top = make_folder('listed', { 'x/a.glb': 'unit_cube.glb', 'y/b.gltf': '{}', 'list.txt': 'x/a.glb\r\n\n' + test_asset('occluder.glb') + '\n' })
  const in_top = (args, input) => spawnSync(program(), args.map(String), { cwd: top, input, encoding: 'utf8' })
  assert.equal(in_top(['--batch', 'list.txt', 'out', ...quick]).status, 0)
  assert.deepEqual(files_in(path.join(top, 'out')), ['occluder.glb', 'x/a.glb'])
  const { status, stdout } = in_top(['--batch', '-', 'piped', '--json', '-', ...quick], 'y/b.gltf\nx/a.glb\nnone.glb\n')
  assert.equal(status, 1)
  assert.deepEqual(exit_codes(valid_report(stdout, 'batch')), [1, 0, 1])
  assert.deepEqual(files_in(path.join(top, 'piped')), ['x/a.glb'])
})

test('what would write a file twice or replace an input is refused before anything is baked', () => {
  const top = make_folder('refused', { 'x/a.glb': 'unit_cube.glb', 'y/a.glb': 'unit_cube.glb', empty: '' })
  const at = (name) => path.join(top, name)
  const same = `${at('x/a.glb')}\n${at('y/a.glb')}\n`
  fs.writeFileSync(at('same'), same)
  fs.writeFileSync(at('own'), at('x/a.glb'))
  const refusals = [
    [[at('same'), at('out')], 2, /would both become/],
    [[at('own'), at('x')], 2, /is an input/],
    [[at('x'), at('x')], 2, /would replace/],
    [[at('x/a.glb'), at('out')], 2, /no folder and no list/],
    [[at('empty'), at('out')], 1, /names no file/],
    [[at('missing'), at('out')], 1, /cannot be read/],
  ]
  const before = files_in(top)
  for (const [args, exit_code, message] of refusals) {
    const { code, lines } = run('--batch', ...args, ...quick)
    assert.equal(code, exit_code, args.join(' '))
    assert.equal(lines.length, 1, lines.join('\n'))
    assert.match(lines[0], message)
  }
  assert.deepEqual(files_in(top), before)
  assert.equal(run(test_asset('unit_cube.glb'), at('x.glb'), '--jobs', 2).code, 2, '--jobs without --batch')
})

// A batch whose first file takes minutes; `act` gets its process and the number of that file's one.
async function disturbed(name, options, act) {
  const input = make_folder(name, { '1.glb': 'cornell_box.glb', '2.glb': 'no glTF' })
  const json = path.join(folder, `${name}.json`)
  const args = ['--batch', input, path.join(folder, `${name} baked`), '--json', json, ...options]
  const batch = spawn(program(), args, { stdio: ['ignore', 'ignore', 'pipe'] })
  const ended = new Promise((resolve) => batch.on('exit', (code, signal) => resolve({ code, signal, at: Date.now() })))
  // With two jobs the line of the second file says that the first one runs.
  await new Promise((resolve) => batch.stderr.once('data', resolve))
  batch.stderr.resume()
  const child = fs.readFileSync(`/proc/${batch.pid}/task/${batch.pid}/children`, 'utf8').trim()
  const start = Date.now()
  act(batch, Number(child))
  const { code, signal, at } = await ended
  return { code, signal, seconds: (at - start) / 1000, report: report_of(json), output: path.join(folder, `${name} baked`) }
}

test('a file that crashes ends with 70, and the others are baked', async () => {
  const { code, report } = await disturbed('crashed', ['--jobs', 2, ...endless], (_, child) => process.kill(child, 'SIGSEGV'))
  assert.equal(code, 70)
  // The process catches the signal itself (tools/last_resort), or a sanitizer does (CMakePresets.json).
  assert.deepEqual(exit_codes(report), [70, 1])
})

test('a file that the system kills for its memory ends with 4, and the others are baked', async () => {
  const { code, report } = await disturbed('killed', ['--jobs', 2, ...endless], (_, child) => process.kill(child, 'SIGKILL'))
  assert.equal(code, 4)
  assert.deepEqual(exit_codes(report), [137, 1])
  assert.equal(report.files[0].report.error.code, 'limit')
})

for (const [signal, exit_code] of [['SIGINT', 130], ['SIGTERM', 143]]) {
  test(`${signal} stops a batch within a second, with a report and nothing half written`, async () => {
    const { code, seconds, report, output } = await disturbed(signal, ['--jobs', 2, ...endless], (batch) => batch.kill(signal))
    assert.equal(code, exit_code)
    assert.ok(seconds < (sanitized() ? 10 : 1.5), `${seconds} s`)
    assert.equal(report.files[0].report.error.code, 'cancelled')
    assert.deepEqual(files_in(output), [])
  })
}

test('a batch that dies takes its children along', async () => {
  const input = make_folder('orphan', { '1.glb': 'cornell_box.glb', '2.glb': 'no glTF' })
  const batch = spawn(program(), ['--batch', input, path.join(folder, 'orphan baked'), '--jobs', '2', ...endless], { stdio: ['ignore', 'ignore', 'pipe'] })
  await new Promise((resolve) => batch.stderr.once('data', resolve))
  const child = fs.readFileSync(`/proc/${batch.pid}/task/${batch.pid}/children`, 'utf8').trim()
  assert.ok(fs.existsSync(`/proc/${child}`))
  // The child holds the pipe of stderr open as long as it lives.
  const closed = new Promise((resolve) => batch.stderr.on('close', resolve))
  batch.stderr.resume()
  batch.kill('SIGKILL')
  await closed
})

test('processes with the same target, and batches into one folder, do not disturb each other', async () => {
  const input = make_folder('crowd', { 'a.glb': 'occluder.glb', 'b.gltf': 'multi_buffer.gltf' })
  for (const name of ['ground.bin', 'wall geometry.bin', 'textures']) fs.cpSync(test_asset(name), path.join(input, name), { recursive: true })
  const output = path.join(folder, 'crowd baked')
  const start = (...args) => new Promise((resolve) => {
    const child = spawn(program(), [...args, '--progress', 'none', ...quick].map(String), { stdio: ['ignore', 'ignore', 'inherit'] })
    child.on('exit', resolve)
  })
  assert.equal(run('--batch', input, output, ...quick).code, 0)
  const contents = () => Object.fromEntries(files_in(output).map((file) => [file, fs.readFileSync(path.join(output, file), 'base64')]))
  const before = contents()
  const crowd = [...Array(3)].map(() => start('--batch', input, output, '--jobs', 2))
  for (const name of ['a.glb', 'b.gltf', 'a.glb', 'b.gltf']) crowd.push(start(path.join(input, name), path.join(output, name)))
  assert.deepEqual(await Promise.all(crowd), crowd.map(() => 0))
  assert.deepEqual(contents(), before)
})
