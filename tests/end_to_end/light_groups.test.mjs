// --light-groups: the light of each group by itself; together they are the whole.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, cheapest, run, sanitized, temporary_folder, test_asset } from './command_line.mjs'
import { read_compressed } from './compressed_file.mjs'
import { primitives_of_scene, read_accessor, read_gltf } from './gltf_file.mjs'
import { new_errors } from './validator.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)
const asset = (scene) => [test_asset(`${scene}.glb`), test_asset(`${scene}.gltf`)].find((file) => fs.existsSync(file))

// How many things shine in a file: nodes with a light, and materials that emit.
function shining_count({ json: { nodes = [], materials = [] } }) {
  const emits = ({ emissiveFactor = [0, 0, 0], extensions }) => Math.max(...emissiveFactor) > 0 && !extensions?.KHR_materials_unlit
  return nodes.filter(({ extensions }) => extensions?.KHR_lights_punctual).length + materials.filter(emits).length
}

// Every scene of test_assets with two or more of these.
const lit_scenes = fs.readdirSync(test_asset('')).filter((name) => /\.(glb|gltf)$/.test(name))
  .filter((name) => shining_count(read_gltf(test_asset(name))) >= 2).map((name) => name.replace(/\.\w+$/, ''))
const plain = [...cheapest, '--refine', 'none']

// [r, g, b] of each vertex of every baked primitive, in the order of the file.
const rgb = (gltf, accessor) => read_accessor(gltf, accessor).map((row) => row.slice(0, 3))
const is_baked = ([, primitive]) => primitive.attributes?.COLOR_0 !== undefined
const baked_primitives = (gltf) => primitives_of_scene(gltf).filter(is_baked)
const colors_of = (gltf) => baked_primitives(gltf).flatMap(([, { attributes }]) => rgb(gltf, attributes.COLOR_0))
const groups_of = (gltf) => gltf.json.asset.extras.radiosity.lightGroups.groups

const sums = {
  morph: (gltf) => baked_primitives(gltf).flatMap(([node, { attributes, targets = [] }]) => {
    const { weights } = gltf.json.meshes[gltf.json.nodes[node].mesh]
    const lights = targets.map(({ COLOR_0 }) => rgb(gltf, COLOR_0))
    return rgb(gltf, attributes.COLOR_0).map((base, v) => base.map((band, k) =>
      lights.reduce((sum, light, t) => sum + weights[t] * light[v][k], band)))
  }),
  attributes: (gltf) => baked_primitives(gltf).flatMap(([, { attributes }]) => {
    const lights = groups_of(gltf).map(({ attribute }) => rgb(gltf, attributes[attribute]))
    return lights[0].map((_, v) => [0, 1, 2].map((k) => lights.reduce((sum, light) => sum + light[v][k], 0)))
  }),
}

const clipped = (value) => Math.min(value, 1)

// The largest difference once both end at white.
const difference = (a, b) => a.reduce((most, row, v) => row.reduce((largest, value, k) =>
  Math.max(largest, Math.abs(clipped(value) - clipped(b[v][k]))), most), 0)

test('there are scenes with several lights', () => assert.ok(lit_scenes.length >= 3, `${lit_scenes}`))

for (const scene of lit_scenes) {
  test(`the groups of ${scene} add up to the whole within 1e-5`, () => {
    const [whole, morph, attributes] = ['whole', 'morph', 'attributes'].map((name) => target(`${scene}_${name}.glb`))
    bake(asset(scene), whole, ...plain)
    const expected = colors_of(read_gltf(whole))
    const { lightGroups } = bake(asset(scene), attributes, ...plain, '--light-groups', 'attributes')
    assert.deepEqual(groups_of(read_gltf(attributes)).map(({ name }) => name), lightGroups)
    assert.ok(difference(colors_of(read_gltf(attributes)), expected) < 1e-5, 'COLOR_0 is another one')
    const sum = sums.attributes(read_gltf(attributes))
    assert.equal(sum.length, expected.length)
    assert.ok(difference(sum, expected) < 1e-5, `attributes are off by ${difference(sum, expected)}`)
    bake(asset(scene), morph, ...plain, '--light-groups', 'morph')
    const morphed = difference(sums.morph(read_gltf(morph)), expected)
    assert.ok(morphed < 1e-5, `morph targets are off by ${morphed}`)
  })
}

const encodings = { float: [], u16: ['--color-type', 'u16'], u8: ['--color-type', 'u8'], draco: ['--draco'],
  draco_u16: ['--draco', '--color-type', 'u16'], meshopt: ['--meshopt'], scaled: ['--color-type', 'u16', '--scale-to-factor'] }
const rounding = { float: 1e-5, u16: 3e-5, u8: 1.6 / 255, draco: 1e-4, draco_u16: 3e-5, meshopt: 5e-5, scaled: 3e-5 }

for (const storage of ['morph', 'attributes']) {
  for (const [encoding, options] of Object.entries(encodings)) {
    if (sanitized() && !['u16', 'draco', 'meshopt'].includes(encoding)) continue
    test(`${storage} as ${encoding}: valid, and the sum is the whole within rounding`, async () => {
      const output = target(`${storage}_${encoding}.glb`)
      bake(asset('lights_all_kinds'), output, ...plain, ...options, '--light-groups', storage)
      assert.deepEqual(await new_errors(asset('lights_all_kinds'), output), [])
      const gltf = read_compressed(output)
      const whole = target(`whole_${encoding}.glb`)
      bake(asset('lights_all_kinds'), whole, ...plain, ...options)
      // Compressed vertices come in another order: means tell as much.
      const mean = (colors) => [0, 1, 2].map((k) => colors.reduce((sum, row) => sum + clipped(row[k]), 0) / colors.length)
      const [found, expected] = [mean(sums[storage](gltf)), mean(colors_of(read_compressed(whole)))]
      found.forEach((band, k) => assert.ok(Math.abs(band - expected[k]) < groups_of(gltf).length * rounding[encoding], `${found}, not ${expected}`))
    })
  }
}

test('files: the whole and each group beside it, which add up', async () => {
  const output = target('parts.glb')
  const { lightGroups } = bake(asset('lights_all_kinds'), output, ...plain, '--light-groups', 'files', '--exposure', '0.001')
  const files = fs.readdirSync(folder).filter((name) => name.startsWith('parts.') && name !== 'parts.glb')
  assert.equal(files.length, lightGroups.length)
  const parts = files.map((name) => colors_of(read_gltf(target(name))))
  for (const name of files) assert.deepEqual(await new_errors(asset('lights_all_kinds'), target(name)), [])
  const sum = parts[0].map((_, v) => [0, 1, 2].map((k) => parts.reduce((all, part) => all + part[v][k], 0)))
  assert.ok(difference(sum, colors_of(read_gltf(output))) < 1e-5, `${difference(sum, colors_of(read_gltf(output)))}`)
})

test('files: all of them appear or none', () => {
  const blocked = target('blocked.glb')
  const { lightGroups } = bake(asset('two_rooms'), target('names.glb'), ...plain, '--light-groups', 'files')
  const last = lightGroups.at(-1).replace(/[^A-Za-z0-9]/g, '_')
  fs.mkdirSync(target(`blocked.${last}.glb`))
  const { code, lines } = run(asset('two_rooms'), blocked, ...plain, '--progress', 'none', '--light-groups', 'files')
  assert.equal(code, 3, lines.join('\n'))
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.includes('blocked')), [`blocked.${last}.glb`])
})

test('--group puts lamps together, by patterns of their names', () => {
  const output = target('together.glb')
  const { lightGroups } = bake(asset('lights_all_kinds'), output, ...plain, '--light-groups', 'morph', '--group', 'all=*')
  assert.deepEqual(lightGroups, ['all'])
})

test('what cannot be kept apart is refused in one line', () => {
  const output = target('refused.glb')
  for (const [code, ...options] of [[2, '--light-groups', 'morph', '--group', 'a=no such lamp'], [2, '--group', 'a=*'],
    [2, '--light-groups', 'morph', '--solver', 'progressive'], [2, '--light-groups', 'morph', '--simplify']]) {
    const result = run(asset('lights_all_kinds'), output, ...plain, '--progress', 'none', ...options)
    assert.equal(result.code, code, result.lines.join('\n'))
    assert.equal(result.lines.length, 1, result.lines.join('\n'))
    assert.ok(!fs.existsSync(output))
  }
})

test('any number of threads gives the same bytes', () => {
  const [one, many] = [1, 5].map((threads) => {
    const output = target(`threads_${threads}.glb`)
    bake(asset('two_rooms'), output, ...plain, '--light-groups', 'morph', '--threads', threads)
    return fs.readFileSync(output)
  })
  assert.ok(one.equals(many))
})
