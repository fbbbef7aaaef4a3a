// Runs the built command line as a person or a pipeline would.
import { spawnSync } from 'node:child_process'
import fs from 'node:fs'
import os from 'node:os'
import path from 'node:path'
import { valid_report } from './report_schema.mjs'

// Where CTest says that a thing is; a test without it must fail.
export function from_environment(name) {
  const value = process.env[name]
  if (!value) throw new Error(`${name} is not set: run these tests through ctest`)
  return value
}

export const program = () => from_environment('GLTF_RADIOSITY_CLI')
export const test_asset = (name) => path.join(from_environment('GLTF_RADIOSITY_TEST_ASSETS'), name)
// The cheapest bake that goes through every phase, where it is not asked how good the light is.
export const cheapest = ['--quality', 'draft', '--max-patches', '500', '--hemicube', '8', '--residual', '0.05']

// Sanitizers make everything ten times slower: tests then take fewer scenes.
export const sanitized = () => process.env.GLTF_RADIOSITY_SANITIZED === '1'

const folders = []

// A folder that goes away with the process.
export function temporary_folder() {
  if (folders.length === 0) process.on('exit', () => { for (const folder of folders) fs.rmSync(folder, { recursive: true, force: true }) })
  folders.push(fs.mkdtempSync(path.join(os.tmpdir(), 'gltf-radiosity-test-')))
  return folders.at(-1)
}

// { code, signal, stdout, stderr, lines (of stderr), seconds }
export const run = (...args) => run_command(program(), args)

// The same with more time than the five minutes that any other run may take.
export const run_for = (seconds, ...args) => run_command(program(), args, seconds)

// The same with so much memory of its own at most. Sanitizers need more than any limit worth testing.
export function run_within(mebibytes, ...args) {
  if (sanitized()) return run(...args)
  return run_command('sh', ['-c', `ulimit -d ${1024 * mebibytes} && exec "$@"`, 'sh', program(), ...args])
}

function run_command(command, args, most_seconds = 300) {
  const start = process.hrtime.bigint()
  const limits = { encoding: 'utf8', timeout: 1000 * most_seconds, maxBuffer: 1 << 28 }
  const { status, signal, stdout, stderr, error } = spawnSync(command, args.map(String), limits)
  if (error && error.code !== 'ETIMEDOUT') throw error
  const seconds = Number(process.hrtime.bigint() - start) / 1e9
  const lines = stderr.split('\n').filter((line) => line !== '')
  return { code: status, signal, stdout, stderr, lines, seconds }
}

// Bakes or throws; answers the report, which is as docs/report.schema.json has it.
export function bake(input, output, ...options) {
  const { code, signal, stdout, stderr } = run(input, output, '--progress', 'none', '--json', '-', ...options)
  if (code !== 0) throw new Error(`exit ${code ?? signal} for ${[input, ...options].join(' ')}\n${stderr}`)
  return valid_report(stdout)
}
