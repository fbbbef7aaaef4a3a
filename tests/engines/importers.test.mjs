// Importers outside browsers find the colours of every output mode that they can read.
import assert from 'node:assert/strict'
import { execFileSync, spawnSync } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { fileURLToPath } from 'node:url'
import { bake, from_environment, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { read_compressed } from '../end_to_end/compressed_file.mjs'
import { read_gltf } from '../end_to_end/gltf_file.mjs'
import { assert_same_corners, corners_of } from './corners.mjs'

const folder = temporary_folder()
const to_linear = (code) => (code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4)
const modes = {
  float: [], u16: ['--color-type', 'u16'], u8: ['--color-type', 'u8'], draco: ['--draco'],
  draco_u16: ['--draco', '--color-type', 'u16'], scaled: ['--color-type', 'u16', '--scale-to-factor'],
  godot_3: ['--engine', 'godot', '--color-type', 'float'],
}

// The Cornell box in a mode: its nodes do not move their meshes.
function baked(mode) {
  const output = path.join(folder, `${mode}.glb`)
  bake(test_asset('cornell_box.glb'), output, '--quality', 'draft', '--refine', 'none', ...modes[mode])
  return output
}

for (const mode of Object.keys(modes)) {
  test(`Assimp reads ${mode} colours`, () => {
    const file = baked(mode)
    const exported = path.join(folder, `${mode}_assimp.gltf`)
    execFileSync('assimp', ['export', file, exported], { stdio: 'pipe' })
    assert_same_corners(corners_of(read_gltf(exported)), corners_of(read_compressed(file)), 0.1, mode)
  })

  test(`tinygltf reads ${mode} colours`, () => {
    const file = baked(mode)
    const { status, stdout, stderr } = spawnSync(from_environment('TINYGLTF_READER'), [file], { encoding: 'utf8' })
    assert.equal(status, 0, stderr)
    const found = stdout.trim().split('\n').map((line) => line.split(' ').map(Number))
      .map((numbers) => ({ position: numbers.slice(0, 3), color: numbers.slice(3) }))
    assert_same_corners(found, corners_of(read_compressed(file)), 0.1, mode)
  })
}

// What Godot makes of the only file of a project: [{ position, color }]
function read_by_godot(file) {
  // Exporting a pack imports what is in the project first, and then comes to an end.
  const project = fs.mkdtempSync(path.join(folder, 'godot-'))
  fs.writeFileSync(path.join(project, 'project.godot'), 'config_version=4\n')
  fs.writeFileSync(path.join(project, 'export_presets.cfg'),
    '[preset.0]\nname="pack"\nplatform="Linux/X11"\nexport_filter="all_resources"\n[preset.0.options]\n')
  fs.copyFileSync(file, path.join(project, 'box.glb'))
  const godot = (...options) => {
    const { stdout, error } = spawnSync('godot3-server', ['--path', project, ...options], { encoding: 'utf8', timeout: 120_000,
      maxBuffer: 1 << 28, env: { ...process.env, HOME: folder } })
    if (error) throw error
    return stdout
  }
  godot('--export-pack', 'pack', path.join(folder, 'godot.zip'))
  const output = godot('-s', fileURLToPath(new URL('godot_colors.gd', import.meta.url)))
  const seen = JSON.parse(output.split('\n').find((line) => line.startsWith('COLORS ')).slice('COLORS '.length))
  return seen['box.glb'].map((numbers) => ({
    position: numbers.slice(0, 3), color: [3, 4, 5].map((k) => numbers[k] * to_linear(numbers[k + 3])),
  }))
}

for (const mode of ['float', 'godot_3']) {
  test(`Godot 3 reads ${mode} colours`, () => {
    const file = baked(mode)
    // It stores eight bits, linear, cut off.
    assert_same_corners(read_by_godot(file), corners_of(read_gltf(file)), 1.1, mode, (linear) => linear)
  })
}
