// Every way the colours are written looks the same in three.js, and right in Babylon.js.
import assert from 'node:assert/strict'
import path from 'node:path'
import test from 'node:test'
import { bake, sanitized, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { open_viewer } from './browser.mjs'
import { assert_shown, pixels_of } from './probes.mjs'

const folder = temporary_folder()
const modes = {
  float: ['--color-type', 'float'],
  u16: ['--color-type', 'u16'],
  draco: ['--draco'],
  draco_u16: ['--draco', '--color-type', 'u16'],
  meshopt: ['--meshopt'],
  scaled: ['--color-type', 'u16', '--scale-to-factor'],
}
const view = { width: 320, height: 240 }

// A scene in some modes, { mode: file }.
function baked(scene, names, ...options) {
  return Object.fromEntries(names.map((mode) => {
    const how = modes[mode]
    const output = path.join(folder, `${scene}_${mode}.glb`)
    bake(test_asset(`${scene}.glb`), output, '--quality', 'draft', ...options, ...how)
    return [mode, output]
  }))
}

// By how many codes two pictures differ, where they differ most.
const difference = (a, b) => a.reduce((most, code, k) => Math.max(most, Math.abs(code - b[k])), 0)

test('every output mode', async (t) => {
  const box = baked('cornell_box', sanitized() ? ['float', 'draco', 'meshopt'] : Object.keys(modes), '--refine', 'uniform', '--patch-size', sanitized() ? 2 : 1)
  const room = baked('textured_interior', ['float', 'draco', 'meshopt'], '--refine', 'none')

  await t.test('three.js shows the same pixels, to one code, whatever the colours are stored as', async (t) => {
    const { page, close } = await open_viewer()
    t.after(close)
    for (const files of [box, room]) {
      const reference = await pixels_of(page, files.float, view)
      for (const [mode, file] of Object.entries(files)) {
        const codes = difference(await pixels_of(page, file, view), reference)
        assert.ok(codes <= 1, `${mode}: ${codes} codes`)
      }
    }
  })

  await t.test('Babylon.js shows what the numbers say', async (t) => {
    const { page, close } = await open_viewer('babylon.html')
    t.after(close)
    for (const file of Object.values(box)) {
      const mean = await assert_shown(page, file, { ...view, tolerance: 2, least_probes: 400 })
      t.diagnostic(`${path.basename(file)}: mean error ${mean.toFixed(2)} of 255`)
    }
  })
})
