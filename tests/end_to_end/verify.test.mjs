// `gltf-radiosity verify`: proof of a bake, through the command line.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, run, temporary_folder, test_asset } from './command_line.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)
const few = ['--points', 300, '--max-samples', 256, '--progress', 'none']

const scene = test_asset('cornell_box_1500.glb')
const baked = target('baked.glb')
bake(scene, baked, '--quality', 'draft', '--refine', 'none')

function report_of(input, output, ...options) {
  const { code, stdout, stderr } = run('verify', input, output, ...few, '--json', '-', ...options)
  assert.equal(code, 0, stderr)
  return JSON.parse(stdout)
}

test('a bake of the Cornell box is within 6 % of the truth', () => {
  const { relativeRmse, exposure, writtenExposure, points, unmatchedPoints } = report_of(scene, baked)
  assert.ok(relativeRmse < 0.06, `${100 * relativeRmse} %`)
  assert.ok(Math.abs(exposure / writtenExposure - 1) < 0.03, `${exposure}, not ${writtenExposure}`)
  assert.ok(points > 250 && unmatchedPoints === 0, `${points} points`)
})

test('the result goes to stdout, for people', () => {
  const { code, stdout, stderr } = run('verify', scene, baked, ...few)
  assert.equal(code, 0, stderr)
  assert.match(stdout, /^relative RMSE \d+\.\d\d % .*\nexposure .*\n\d+ of 300 points .*\n$/)
})

test('any number of threads gives the same report', () => {
  const [one, many] = [1, 5].map((threads) => {
    const { phases, ...report } = report_of(scene, baked, '--threads', threads)
    return report
  })
  assert.deepEqual(one, many)
})

test('a bake that is worse than --max-error ends with 5 and one line', () => {
  assert.equal(run('verify', scene, baked, ...few, '--max-error', '0.5').code, 0)
  const { code, stdout, lines } = run('verify', scene, baked, ...few, '--max-samples', 1024, '--max-error', '0.0001')
  assert.equal(code, 5)
  assert.match(stdout, /^relative RMSE/)
  assert.match(lines.at(-1), /^gltf-radiosity: error: the relative RMSE of .* is above --max-error/)
})

test('a picture appears, and only under its full name', () => {
  const picture = target('error.png')
  const { code, stderr } = run('verify', scene, baked, ...few, '--image', picture, '--size', '64,48', '--image-samples', 4)
  assert.equal(code, 0, stderr)
  assert.equal(fs.readFileSync(picture).subarray(1, 4).toString(), 'PNG')
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.startsWith('error')), ['error.png'])
})

test('what is not baked, or not the same scene, is refused in one line', () => {
  const refused = [[scene, scene], [test_asset('unit_cube.glb'), baked], [scene, target('no_such.glb')]]
  for (const files of refused) {
    const { code, stdout, lines } = run('verify', ...files, ...few)
    assert.equal(code, 1, lines.join('\n'))
    assert.equal(stdout, '')
    assert.equal(lines.length, 1, lines.join('\n'))
  }
})
