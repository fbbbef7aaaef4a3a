// Every test scene, with the options that change what is written.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { check_baked } from './baked.mjs'
import { bake, cheapest, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'

const folder = temporary_folder()
const all_option_sets = [
  { output: 'as_it_is.glb', options: ['--refine', 'none'] },
  { output: 'uniform.gltf', options: ['--refine', 'uniform', '--color-type', 'u16'] },
  { output: 'adaptive.glb', options: ['--refine', 'adaptive', '--max-vertices', '2000', '--simplify'] },
  { output: 'simplified.embedded.gltf', options: ['--refine', 'none', '--simplify', '--color-type', 'u8', '--sky', '0.2,0.3,0.5'] },
]
// Sanitizers look for what the code does, and the last set goes wherever the first one goes.
const option_sets = sanitized() ? all_option_sets.slice(1) : all_option_sets
const scenes = fs.readdirSync(test_asset('')).filter((name) => /\.(glb|gltf)$/.test(name))
// Under sanitizers the large Cornell boxes and rooms take minutes, and have nothing that the small ones have not.
const too_slow = sanitized()
  ? ['cornell_box_5000.glb', 'cornell_box_1500.glb', 'two_rooms.glb', 'white_furnace_50.glb', 'white_furnace_90.glb']
  : []

test('the test scenes have been made', () => assert.ok(scenes.length >= 20, `${scenes.length} scenes`))

for (const scene of scenes.filter((name) => !too_slow.includes(name))) {
  for (const { output, options } of option_sets) {
    test(`${scene} bakes with ${options.join(' ')} to ${output.replace(/^\w+/, '')}`, async () => {
      const target = path.join(folder, scene, output)
      fs.mkdirSync(path.dirname(target), { recursive: true })
      bake(test_asset(scene), target, ...cheapest, ...options)
      await check_baked(test_asset(scene), target)
    })
  }
}

// Vertices inside a neighbour's edge: those that a file comes with may stay, there are never more.
const t_vertices = (scene, target) => {
  const { code, stdout, stderr } = run('verify', scene, target, '--points', 1, '--max-samples', 64, '--progress', 'none', '--json', '-')
  assert.equal(code, 0, stderr)
  return JSON.parse(stdout).tVertices
}

for (const scene of sanitized() ? [] : scenes) {
  test(`${scene} gets no crack`, () => {
    const baked = (output) => path.join(folder, scene, output)
    const before = t_vertices(test_asset(scene), baked('as_it_is.glb'))
    for (const output of ['uniform.gltf', 'adaptive.glb', 'simplified.embedded.gltf']) {
      assert.ok(t_vertices(test_asset(scene), baked(output)) <= before, output)
    }
  })
}
