// Corners of triangles with the colours they show: the same in a file and in what an importer made of it.
import assert from 'node:assert/strict'
import { world_triangles } from './geometry.mjs'

const to_srgb = (linear) => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055)

// [{ position (world), color (linear RGB, COLOR_0 x base colour factor) }] of the default scene.
export function corners_of(gltf) {
  return world_triangles(gltf).flatMap(({ corners, attributes, primitive }) => {
    const { baseColorFactor = [1, 1, 1, 1] } = gltf.json.materials[primitive.material].pbrMetallicRoughness ?? {}
    return corners.map((position, k) => (
      { position, color: attributes.COLOR_0[k].slice(0, 3).map((band, i) => band * baseColorFactor[i]) }))
  })
}

// Every expected corner is among those that were found, to `codes` of 255 codes of `encode`d colours; there are as many of
// both.
export function assert_same_corners(found, expected, codes, place, encode = to_srgb) {
  assert.equal(found.length, expected.length, `${place}: corners`)
  const cell = (position) => position.map((x) => Math.round(x * 1e3)).join()
  const cells = new Map()
  for (const corner of found) {
    // A position on the border of a cell may be rounded either way.
    for (const shift of [-4e-4, 4e-4]) {
      const key = cell(corner.position.map((x) => x + shift))
      cells.set(key, [...(cells.get(key) ?? []), corner])
    }
  }
  const apart = (a, b) => Math.max(...a.map((band, k) => 255 * Math.abs(encode(band) - encode(b[k]))))
  for (const { position, color } of expected) {
    const candidates = [-4e-4, 4e-4].flatMap((shift) => cells.get(cell(position.map((x) => x + shift))) ?? [])
    const nearest = Math.min(...candidates.map((candidate) => apart(candidate.color, color)))
    assert.ok(nearest <= codes, `${place}: ${position} shows ${nearest} codes off ${color}`)
  }
}
