// --draco and --meshopt: other people's decoders find the triangles, colours and all else of the plain file.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { check_baked } from './baked.mjs'
import { bake, cheapest, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { read_compressed } from './compressed_file.mjs'
import { primitives_of_scene, read_accessor, read_gltf, triangles_of } from './gltf_file.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)
const modes = { draco: ['--draco'], meshopt: ['--meshopt'] }

// How far values may be from the plain ones, in the units of the attribute; custom attributes and joints not at all.
const tolerance_of = (semantic, extent) => {
  if (semantic === 'POSITION') return extent / (1 << 14)
  if (/^(NORMAL|TANGENT)$/.test(semantic)) return 1e-3
  if (/^(TEXCOORD|WEIGHTS|COLOR)_/.test(semantic)) return 2e-5
  return 0
}

// Corners of the triangles of a primitive, as [semantic -> row]: the order of vertices and triangles is the encoder's.
function corners_of(gltf, primitive) {
  const rows = Object.entries(primitive.attributes).map(([name, index]) => [name, read_accessor(gltf, index)])
  const degenerate = ([a, b, c]) => a === b || b === c || c === a
  return triangles_of(gltf, primitive).filter((triangle) => !degenerate(triangle))
    .map((triangle) => triangle.map((vertex) => Object.fromEntries(rows.map(([name, values]) => [name, values[vertex]]))))
}

const extent_of = (points) => Math.max(...[0, 1, 2].map((k) =>
  Math.max(...points.map((point) => point[k])) - Math.min(...points.map((point) => point[k]))))

// Each triangle of `plain` is one of `decoded`, attribute by attribute.
function assert_same_triangles(plain, decoded, place) {
  assert.equal(decoded.length, plain.length, `${place}: triangles`)
  const extent = extent_of(plain.flat().map(({ POSITION }) => POSITION))
  const differs = (a, b) => Object.keys(a).some((name) => {
    const tolerance = tolerance_of(name, extent)
    return a[name].some((value, k) => Math.abs(value - b[name][k]) > tolerance)
  })
  // Triangles by the cell of their centre, so that not every pair is looked at.
  const cell_size = (extent / 16) || 1
  const centre = (triangle) => [0, 1, 2].map((k) => triangle.reduce((sum, { POSITION }) => sum + POSITION[k], 0) / 3)
  const cells = new Map()
  for (const triangle of decoded) {
    const key = centre(triangle).map((x) => Math.floor(x / cell_size)).join()
    cells.set(key, [...(cells.get(key) ?? []), triangle])
  }
  for (const triangle of plain) {
    const candidates = new Set()
    for (const shift of [-0.01, 0.01].flatMap((x) => [-0.01, 0.01].flatMap((y) => [-0.01, 0.01].map((z) => [x, y, z])))) {
      const key = centre(triangle).map((x, k) => Math.floor(x / cell_size + shift[k])).join()
      for (const candidate of cells.get(key) ?? []) candidates.add(candidate)
    }
    const turns = [[0, 1, 2], [1, 2, 0], [2, 0, 1]]
    const found = [...candidates].some((candidate) =>
      turns.some((turn) => triangle.every((corner, k) => !differs(corner, candidate[turn[k]]))))
    assert.ok(found, `${place}: ${JSON.stringify(triangle)} is lost`)
  }
}

const scenes = ['cornell_box', 'textured_interior', 'mirrored_instance', 'skinned_and_morphed', 'strip', 'non_manifold',
  'extras_everywhere', 'points_and_lines', 'already_coloured', 'instanced', 'meshopt_compressed']

for (const scene of scenes) {
  test(`${scene} holds the same, compressed or not`, async () => {
    const input = test_asset(`${scene}.glb`)
    const common = [...cheapest, ...(scene === 'cornell_box' ? ['--refine', 'uniform', '--patch-size', 1] : ['--refine', 'none'])]
    bake(input, target('plain.glb'), ...common, '--color-type', 'u16')
    const plain = read_gltf(target('plain.glb'))
    for (const [mode, options] of Object.entries(modes)) {
      const output = target(`${mode}.glb`)
      bake(input, output, ...common, ...options, '--color-type', 'u16')
      const { output: decoded } = await check_baked(input, output, { data_moves: true })
      const [before, after] = [plain, decoded].map(primitives_of_scene)
      assert.equal(after.length, before.length)
      before.forEach(([node, primitive], k) => {
        const place = `${mode}: nodes[${node}]`
        assert.deepEqual(Object.keys(after[k][1].attributes), Object.keys(primitive.attributes), place)
        if ((primitive.mode ?? 4) < 4) assert.deepEqual(read_accessor(decoded, after[k][1].attributes.POSITION),
          read_accessor(plain, primitive.attributes.POSITION))
        else assert_same_triangles(corners_of(plain, primitive), corners_of(decoded, after[k][1]), place)
      })
    }
  })
}

test('colours of floats are within half of 1/65535, and white stays white', () => {
  const options = ['--refine', 'none', ...cheapest, '--exposure', '100']
  bake(test_asset('cornell_box.glb'), target('float.glb'), ...options, '--draco')
  const gltf = read_compressed(target('float.glb'))
  const colors = primitives_of_scene(gltf).flatMap(([, { attributes }]) => read_accessor(gltf, attributes.COLOR_0))
  assert.ok(colors.some(([red]) => red === 1), 'white')
  assert.ok(colors.every((color) => color[3] === 1), 'alpha')
})

test('compressed files are small: neither the old geometry nor the plain one is left in them', () => {
  const options = [...cheapest, '--refine', 'uniform', '--patch-size', 0.25]
  const size = (name, ...more) => {
    bake(test_asset('textured_interior.glb'), target(name), ...options, ...more)
    return fs.statSync(target(name)).size
  }
  const plain = size('plain.glb', '--color-type', 'u16')
  assert.ok(size('draco.glb', '--draco') < 0.45 * plain)
  assert.ok(size('meshopt.glb', '--meshopt') < 0.55 * plain)
})

test('morph targets follow the vertices', () => {
  for (const [mode, options] of Object.entries(modes)) {
    bake(test_asset('skinned_and_morphed.glb'), target(`morph_${mode}.glb`), ...cheapest, '--refine', 'uniform', ...options)
    const gltf = read_compressed(target(`morph_${mode}.glb`))
    const morphed = primitives_of_scene(gltf).map(([, primitive]) => primitive).filter(({ targets }) => targets)
    assert.ok(morphed.length > 0)
    for (const { attributes, targets } of morphed) {
      const rows = read_accessor(gltf, attributes.POSITION).length
      for (const moved of targets) assert.equal(read_accessor(gltf, moved.POSITION).length, rows, mode)
    }
  }
})

test('compressed files are the same bytes with 1, 2 and 7 threads, as .glb and as .gltf', () => {
  for (const [mode, options] of Object.entries(modes)) {
    for (const ending of ['glb', 'gltf']) {
      const [one, ...others] = (sanitized() ? [1, 2] : [1, 2, 7]).map((threads) => {
        const output = target(`${mode}.${ending}`)
        bake(test_asset('textured_interior.glb'), output, ...cheapest, '--refine', 'none', ...options, '--threads', threads)
        return ending === 'glb' ? fs.readFileSync(output) : read_gltf(output).buffers[0]
      })
      for (const other of others) assert.ok(other.equals(one), mode)
    }
  }
})

test('a Draco file is read back and verified', () => {
  bake(test_asset('cornell_box.glb'), target('verified.glb'), '--quality', 'draft', '--draco')
  const { code, stdout, stderr } = run('verify', test_asset('cornell_box.glb'), target('verified.glb'), '--points', 100,
    '--progress', 'none', '--json', '-')
  assert.equal(code, 0, stderr)
  const { relativeRmse, unmatchedPoints, tVertices } = JSON.parse(stdout)
  assert.ok(relativeRmse < 0.1 && unmatchedPoints === 0 && tVertices === 0, stdout)
})
