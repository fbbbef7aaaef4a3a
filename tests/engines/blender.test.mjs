// Blender shows the colours of every output mode that it can read. Not part of CTest: Debian's package is 500 MB.
//
//   tools/setup bench
//   GLTF_RADIOSITY_CLI=build/release/tools/gltf-radiosity GLTF_RADIOSITY_TEST_ASSETS=build/release/test_assets/scenes \
//     node --test tests/engines/blender.test.mjs
import assert from 'node:assert/strict'
import { spawnSync } from 'node:child_process'
import path from 'node:path'
import test from 'node:test'
import { fileURLToPath } from 'node:url'
import { bake, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { read_gltf } from '../end_to_end/gltf_file.mjs'
import { assert_same_corners, corners_of } from './corners.mjs'

const folder = temporary_folder()
const script = fileURLToPath(new URL('blender_colors.py', import.meta.url))
const modes = {
  float: [], u16: ['--color-type', 'u16'], u8: ['--color-type', 'u8'], preset: ['--engine', 'blender'],
  dark: ['--exposure', '0.05'], dark_preset: ['--exposure', '0.05', '--engine', 'blender'],
}

// { file: { emission, corners: { object: [[position, colour], ...] } } }
function read_by_blender(files) {
  const { status, stdout, stderr } = spawnSync('blender', ['--background', '--factory-startup', '--python-exit-code', '1',
    '--python', script, '--', ...files], { encoding: 'utf8', maxBuffer: 1 << 28 })
  assert.equal(status, 0, stderr)
  return JSON.parse(stdout.split('\n').find((line) => line.startsWith('COLORS ')).slice('COLORS '.length))
}

test('Blender', async (t) => {
  const files = Object.entries(modes).map(([mode, options]) => {
    const output = path.join(folder, `${mode}.glb`)
    bake(test_asset('cornell_box.glb'), output, '--quality', 'draft', '--refine', 'none', ...options)
    return output
  })
  const seen = read_by_blender(files)
  for (const file of files) {
    const mode = path.basename(file, '.glb')
    await t.test(`shows ${mode} colours`, () => {
      assert.ok(seen[file].emission, 'materials emit and do not reflect')
      const found = Object.values(seen[file].corners).flat()
        .map(([[x, y, z], color]) => ({ position: [x, z, -y], color }))
      // It stores eight bits of sRGB.
      assert_same_corners(found, corners_of(read_gltf(file)), 1, mode)
    })
  }
})
