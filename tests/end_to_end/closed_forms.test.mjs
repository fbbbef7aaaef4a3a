// Light that is known without computing it, as it arrives in COLOR_0 through the whole program.
import assert from 'node:assert/strict'
import path from 'node:path'
import test from 'node:test'
import { colors_of } from './baked.mjs'
import { bake, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { primitives_of_scene, read_accessor, read_gltf } from './gltf_file.mjs'

const folder = temporary_folder()

// Bakes and answers, for each node by its name, [{ position, normal, color }].
function vertices_of(scene, ...options) {
  const output = path.join(folder, scene)
  bake(test_asset(scene), output, '--exposure', 1, '--refine', 'none', ...options)
  const gltf = read_gltf(output)
  const nodes = {}
  for (const [node, primitive] of primitives_of_scene(gltf)) {
    if (primitive.attributes.COLOR_0 === undefined) continue
    const positions = read_accessor(gltf, primitive.attributes.POSITION)
    const colors = colors_of(gltf, primitive)
    const normals = read_accessor(gltf, primitive.attributes.NORMAL)
    const vertices = positions.map((position, k) => ({ position, normal: normals[k], color: colors[k] }))
    nodes[gltf.json.nodes[node].name] = vertices
  }
  return nodes
}

function assert_near(actual, expected, tolerance, what) {
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what}: ${actual}, not ${expected} +- ${tolerance}`)
}

// Under sanitizers a furnace takes half a minute, and both go the same way.
for (const [percent, solver] of (sanitized() ? [50] : [50, 90]).flatMap((rho) => [[rho, 'gathering'], [rho, 'progressive']])) {
  test(`a white furnace of 0.${percent} shows Le / (1 - rho) within 0.5 % at every vertex (${solver})`, () => {
    const { furnace } = vertices_of(`white_furnace_${percent}.glb`, '--solver', solver)
    for (const { position, color } of furnace) {
      for (const band of color.slice(0, 3)) assert_near(band, 0.5, 0.0025, `vertex at ${position}`)
    }
  })
}

test('a white plane with vertex colours shows them under pi lux', () => {
  const { plane } = vertices_of('already_coloured.glb')
  for (const { position, color } of plane) {
    const source = position[0] < 0 ? [255, 128, 0, 255] : [51, 102, 204, 255]
    // The columns at x = 0 and left of it touch triangles that blend both colours.
    if (Math.abs(position[0]) < 0.6) continue
    color.forEach((band, k) => assert_near(band, source[k] / 255, 0.002, `vertex at ${position}`))
  }
})

// Candela arriving per square metre from the lights of lights_all_kinds.glb, as KHR_lights_punctual defines them.
function irradiance_of_all_lights([x, y, z]) {
  const from_point = (lamp, color, strength) => {
    const to_lamp = lamp.map((at, k) => at - [x, y, z][k])
    const distance = Math.hypot(...to_lamp)
    const cosine = to_lamp[1] / distance
    return color.map((band) => (band * strength(distance, cosine) * cosine) / distance ** 2)
  }
  const windowed = (distance) => Math.max(Math.min(1 - (distance / 4) ** 4, 1), 0)
  const [inner, outer] = [Math.cos(0.3), Math.cos(0.6)]
  const cone = (_, cosine) => 1.5 * Math.min(Math.max((cosine - outer) / Math.max(0.001, inner - outer), 0), 1) ** 2
  const point = from_point([-2, 1, 0], [1, 0.5, 0.25], windowed)
  const spot = from_point([2, 1, 0], [0.25, 0.5, 1], cone)
  return point.map((band, k) => band + spot[k] + 0.2)
}

test('a floor under a point, a spot and a directional light shows rho H / pi', () => {
  const { floor } = vertices_of('lights_all_kinds.glb')
  const brightest = Math.max(...floor.flatMap(({ position }) => irradiance_of_all_lights(position))) * 0.5 / Math.PI
  for (const { position, color } of floor) {
    const irradiance = irradiance_of_all_lights(position)
    // Vertices average their triangles, 12 cm wide: exact in the flat parts, some percent off at the edge of the cone.
    color.slice(0, 3).forEach((band, k) =>
      assert_near(band, (0.5 * irradiance[k]) / Math.PI, 0.08 * brightest, `band ${k} at ${position}`))
  }
})

test('no light leaks below a wall into a dark room', { skip: sanitized() && 'takes minutes under sanitizers' }, () => {
  const { shell } = vertices_of('two_rooms.glb', '--quality', 'draft')
  const lit = shell.filter(({ position: [x] }) => x < 1.85)
  const dark = shell.filter(({ position: [x] }) => x > 2.25)
  const mean = (vertices) => vertices.reduce((sum, { color }) => sum + color[1], 0) / vertices.length
  assert.ok(mean(lit) > 0.05, `the lit room shows ${mean(lit)}`)
  for (const { position, color } of dark) assert_near(color[1], 0, 0.001 * mean(lit), `vertex at ${position}`)
})

test('a mirrored instance shows the mirrored light', () => {
  const { left, right } = vertices_of('mirrored_instance.glb')
  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length
  const brightness = mean(right.map(({ color }) => color[1]))
  assert.ok(brightness > 0.02, `the hook shows ${brightness}`)
  // On the mean: at a shadow's edge the few samples of a triangle are not those of its mirror image.
  const differences = right.map(({ color }, k) => Math.abs(left[k].color[1] - color[1]))
  assert_near(mean(differences), 0, 0.05 * brightness, 'difference')
})

test('vertices on both sides of a seam show the same light', () => {
  const { tube } = vertices_of('uv_seam.glb')
  const lit = tube.filter(({ position: [x, , z] }) => Math.abs(x) < 1e-6 && z > 0)
  assert.equal(lit.length, 10)
  for (const { position, color } of lit) {
    for (const other of lit.filter((vertex) => vertex.position[1] === position[1])) assert.deepEqual(other.color, color)
    assert.ok(color[1] > 0.1, `the seam shows ${color[1]} at ${position}`)
  }
})

// The fit of the file's own vertices swings a little where the shadow ends.
for (const [refine, swing] of [
  ['none', 0.06],
  ['uniform', 0.01],
  ['adaptive', 0.01],
]) {
  test(`a plate casts its shadow with --refine ${refine}`, () => {
    const { floor } = vertices_of('occluder.glb', '--refine', refine)
    for (const { position: [x, , z], color } of floor) {
      const nearest = Math.max(Math.abs(x), Math.abs(z))
      // In the umbra, 2 m wide, light comes only from below the plate, which is black; beyond it from the lamp.
      const cosine = 3 / Math.hypot(x, 3, z)
      const lit = (0.5 * 30 * cosine) / Math.hypot(x, 3, z) ** 2 / Math.PI
      if (nearest < 0.8) assert_near(color[1], 0, 0.001, `shadow at ${x},${z}`)
      const tolerance = nearest > 1.3 ? Math.min(0.02, swing) : swing
      if (nearest > 1.2 && nearest < 1.8) assert_near(color[1], lit, tolerance * lit, `light at ${x},${z}`)
    }
  })
}

test('a court under a sky of 1 cd/m2 is darker in its corners, and nowhere brighter than its reflectance', () => {
  const { ground, north_wall } = vertices_of('sky_court.glb', '--sky', '1,1,1')
  const color_at = (x, z) => ground.find(({ position }) => position[0] === x && position[2] === z).color
  const [open, corner] = [color_at(3, 3)[0], color_at(5, 5)[0]]
  assert.ok(open > 1.1 * corner, `${open} in the open, ${corner} in a corner`)
  for (const { color } of ground) assert.ok(color[0] < 0.4, `the ground shows ${color[0]}`)
  const tops = north_wall.filter(({ position }) => position[1] === 4)
  assert.ok(tops.some(({ color }) => Math.abs(color[0] - 0.7) < 0.01), 'the top of the wall sees all of the sky')
})

test('a floor under an image-based light shows what the faces of its cube map bring', () => {
  const { floor } = vertices_of('image_based_light.glb')
  // The middle of a cube sees its upper face with this form factor.
  const above = (4 / Math.PI / Math.SQRT2) * Math.atan(1 / Math.SQRT2)
  const expected = 0.25 * (2.5 * above + 1 - above)
  for (const { position, color } of floor) assert_near(color[1], expected, 0.02 * expected, `vertex at ${position}`)
})

for (const turned of [0, 90, -45]) {
  test(`a cube under sunny.hdr turned by ${turned} degrees shows sky and sun on each face`, () => {
    const { cube } = vertices_of('unit_cube.glb', '--sky', test_asset('sunny.hdr'), '--sky-rotation', turned)
    const radians = Math.PI / 180
    const azimuth = (270 - (360 * 20.5) / 64 + turned) * radians
    const elevation = (90 - (180 * 7.5) / 32) * radians
    const level = Math.cos(elevation)
    const towards = [level * Math.sin(azimuth), Math.sin(elevation), level * Math.cos(azimuth)]
    const latitude = (row) => Math.sin((90 - (180 * row) / 32) * radians)
    const lux = 512 * ((2 * Math.PI) / 64) * (latitude(7) - latitude(8))
    for (const { normal, color } of cube) {
      const cosine = normal.reduce((sum, n, k) => sum + n * towards[k], 0)
      const irradiance = (Math.PI / 2) * (1 + normal[1]) + lux * Math.max(0, cosine)
      assert_near(color[1], (0.5 * irradiance) / Math.PI, 0.015, `face ${normal}`)
    }
  })
}

test('a point light amid a room compressed by Draco lights the four corners of each wall alike', () => {
  const { box } = vertices_of('draco_box.glb', '--fit', 'interpolate')
  assert.equal(box.length, 24)
  for (const axis of [0, 1, 2]) {
    for (const side of [-1, 1]) {
      const wall = box.filter(({ normal }) => normal[axis] === -side)
      assert.equal(wall.length, 4)
      const mean = wall.reduce((sum, { color }) => sum + color[1], 0) / 4
      assert.ok(mean > 0.05, `a wall shows ${mean}`)
      for (const { position, color } of wall) assert_near(color[1], mean, 0.05 * mean, `corner at ${position}`)
    }
  }
})

test('what meshoptimizer compressed shows the light that it shows without compression', () => {
  const [compressed, plain] = ['meshopt_compressed.glb', 'skinned_and_morphed.glb'].map((scene) => vertices_of(scene))
  for (const name of ['skinned', 'morphed']) {
    plain[name].forEach(({ position, color }, k) =>
      assert_near(compressed[name][k].color[1], color[1], 1e-3, `${name} at ${position}`))
    assert.ok(plain[name].some(({ color }) => color[1] > 0.1), `${name} is dark`)
  }
})

test('instances show the light that nodes in their places show', () => {
  const [copies, nodes] = ['instanced.glb', 'instanced_as_nodes.glb'].map((scene) => vertices_of(scene))
  for (const name of ['floor', 'stones[0]', 'stones[1]', 'stones[2]']) {
    assert.equal(copies[name].length, nodes[name].length)
    nodes[name].forEach(({ position, color }, k) =>
      assert_near(copies[name][k].color[1], color[1], 2e-3, `${name} at ${position}`))
    assert.ok(nodes[name].some(({ color }) => color[1] > 0.05), `${name} is dark`)
  }
})

test('glass lets light through by its factor times its colour, and what is invisible takes no part', () => {
  const { floor, half_pane, ...others } = vertices_of('panes.glb')
  assert.deepEqual(Object.keys(others), [], 'clear glass and what is invisible are not baked')
  const mean = (vertices) => vertices.reduce((sum, { color }) => sum + color[1], 0) / vertices.length
  // Specular-glossiness: the diffuse texture multiplies COLOR_0, which holds what falls on white.
  assert_near(mean(floor.filter(({ position: [x] }) => x < -0.3)), 0.8, 0.03, 'below clear glass of 80 % grey')
  assert_near(mean(floor.filter(({ position: [x] }) => x > 0.3)), 0.5, 0.04, 'below glass that lets half through')
  for (const { color } of half_pane) assert_near(color[1], 1, 0.01, 'the pane itself')
})
