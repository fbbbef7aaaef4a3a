// three.js in a browser, with no lights in the page, shows what COLOR_0 says: pixel by pixel.
import assert from 'node:assert/strict'
import path from 'node:path'
import test from 'node:test'
import { bake, sanitized, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { read_gltf } from '../end_to_end/gltf_file.mjs'
import { open_viewer, url_of } from './browser.mjs'
import { expected_colors } from './expected_colors.mjs'

const folder = temporary_folder()
const step = 10  // pixels between probes

const difference = (a, b) => Math.max(...a.map((code, k) => Math.abs(code - b[k])))

// Probes away from edges, of geometry and of textures: where the corners of the pixel would look the same.
function probes(gltf, width, height) {
  const color_at = expected_colors(gltf, width, height)
  const found = []
  for (let y = step / 2; y < height; y += step) {
    for (let x = step / 2; x < width; x += step) {
      const centre = color_at(x + 0.5, y + 0.5)
      const corners = [[-0.5, -0.5], [1.5, -0.5], [-0.5, 1.5], [1.5, 1.5]].map(([i, j]) => color_at(x + i, y + j))
      if (corners.every((corner) => difference(corner, centre) < 8)) found.push({ x, y, expected: centre })
    }
  }
  return found
}

// The mean error in codes, once no probe is off by more than `tolerance`.
async function assert_shown(page, file, { width, height, tolerance, least_probes }) {
  const draw = ([url, view]) => window.viewer.pixels_of(url, view)
  const pixels = await page.evaluate(draw, [url_of(file), { width, height }])
  const found = probes(read_gltf(file), width, height)
  assert.ok(found.length >= least_probes, `${found.length} probes`)
  assert.ok(found.some(({ expected }) => expected[0] > 128), 'the picture is not dark')
  const errors = found.map(({ x, y, expected }) => {
    const start = 4 * (y * width + x)
    const shown = pixels.slice(start, start + 3)
    const error = difference(shown, expected)
    assert.ok(error <= tolerance, `pixel ${x},${y} shows ${shown}, not ${expected.map((code) => code.toFixed(1))}`)
    return error
  })
  return errors.reduce((sum, error) => sum + error, 0) / errors.length
}

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
    const file = bake_draft('textured_interior', '--patch-size', sanitized() ? '1' : '0.5')
    const mean = await assert_shown(page, file, { width: 400, height: 300, tolerance: 4, least_probes: 500 })
    t.diagnostic(`mean error ${mean.toFixed(2)} of 255`)
  })
})
