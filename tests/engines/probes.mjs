// What a page shows of a baked file, pixel by pixel, beside what its numbers say.
import assert from 'node:assert/strict'
import { read_compressed } from '../end_to_end/compressed_file.mjs'
import { from_base64 } from './base64.mjs'
import { url_of } from './browser.mjs'
import { expected_colors } from './expected_colors.mjs'

const step = 10  // pixels between probes

export const difference = (a, b) => Math.max(...a.map((code, k) => Math.abs(code - b[k])))

// Probes away from edges, of geometry and of textures: where the corners of the pixel would look the same.
export function probes(gltf, width, height) {
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

// RGBA bytes of the picture, rows from the top. `code` is run before (viewer.mjs).
export const pixels_of = async (page, file, view, code = '') =>
  from_base64(await page.evaluate((words) => window.viewer.pixels_of(...words), [url_of(file), view, code]))

// The mean error in codes, once no probe is off by more than `tolerance`.
export async function assert_shown(page, file, { width, height, tolerance, least_probes }) {
  const pixels = await pixels_of(page, file, { width, height })
  return assert_pixels(pixels, probes(read_compressed(file), width, height), { width, tolerance, least_probes })
}

// The same for RGBA bytes, rows from the top.
export function assert_pixels(pixels, found, { width, tolerance, least_probes }) {
  assert.ok(found.length >= least_probes, `${found.length} probes`)
  assert.ok(found.some(({ expected }) => Math.max(...expected) > 96), 'the picture is not dark')
  const errors = found.map(({ x, y, expected }) => {
    const start = 4 * (y * width + x)
    const shown = pixels.slice(start, start + 3)
    const error = difference(shown, expected)
    assert.ok(error <= tolerance, `pixel ${x},${y} shows ${shown}, not ${expected.map((code) => code.toFixed(1))}`)
    return error
  })
  return errors.reduce((sum, error) => sum + error, 0) / errors.length
}
