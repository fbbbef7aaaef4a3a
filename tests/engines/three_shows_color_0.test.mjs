// three.js in a browser, with no lights in the page, shows what COLOR_0 says: pixel by pixel.
import path from 'node:path'
import test from 'node:test'
import { bake, sanitized, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { open_viewer } from './browser.mjs'
import { assert_shown } from './probes.mjs'

const folder = temporary_folder()

test('three.js shows a baked file as COLOR_0 says', async (t) => {
  const { page, close } = await open_viewer()
  t.after(close)
  const bake_draft = (scene, ...options) => {
    const output = path.join(folder, `${scene}${options.join('')}.glb`)
    bake(test_asset(`${scene}.glb`), output, '--quality', 'draft', ...options)
    return output
  }

  for (const type of ['float', 'u16', 'u8']) {
    await t.test(`the Cornell box, ${type}`, async (t) => {
      // Three vertices of a triangle suffice to tell a wrong type; the finer box shows that the light is in its place.
      const scene = type === 'float' && !sanitized() ? 'cornell_box_1500' : 'cornell_box'
      const file = bake_draft(scene, '--refine', 'none', '--color-type', type)
      const mean = await assert_shown(page, file, { width: 320, height: 320, tolerance: 2, least_probes: 600 })
      t.diagnostic(`mean error ${mean.toFixed(2)} of 255`)
    })
  }

  await t.test('a textured interior with wrap modes, a texture transform, a mask and a blended pane', async (t) => {
    const file = bake_draft('textured_interior', '--patch-size', sanitized() ? '1' : '0.5', '--max-vertices', '2500')
    const mean = await assert_shown(page, file, { width: 400, height: 300, tolerance: 4, least_probes: 500 })
    t.diagnostic(`mean error ${mean.toFixed(2)} of 255`)
  })
})
