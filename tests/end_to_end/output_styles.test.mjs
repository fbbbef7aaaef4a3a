// What receives light, which light, and how it is written: for engines that light a part themselves or store 8 bits.
import assert from 'node:assert/strict'
import path from 'node:path'
import test from 'node:test'
import { colors_of, is_unlit, material_of } from './baked.mjs'
import { bake, cheapest, run, temporary_folder, test_asset } from './command_line.mjs'
import { primitives_of_scene, read_accessor, read_gltf } from './gltf_file.mjs'
import { new_errors } from './validator.mjs'

const folder = temporary_folder()
const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length

// { gltf, report } of a bake that the validator has nothing against.
async function baked(scene, ...options) {
  const output = path.join(folder, 'baked.glb')
  const report = bake(test_asset(scene), output, ...cheapest, '--refine', 'none', ...options)
  assert.deepEqual(await new_errors(test_asset(scene), output), [], options.join(' '))
  return { gltf: read_gltf(output), report }
}

const name_of = (gltf, node) => gltf.json.nodes[node].name
// Names of the nodes whose primitives got unlit colours.
const lit_nodes = (gltf) => [...new Set(primitives_of_scene(gltf)
  .filter(([, primitive]) => primitive.attributes.COLOR_0 !== undefined && is_unlit(material_of(gltf, primitive)))
  .map(([node]) => name_of(gltf, node)))].sort()
const shown = (gltf) => primitives_of_scene(gltf).flatMap(([, primitive]) => {
  const { baseColorFactor = [1, 1, 1, 1] } = material_of(gltf, primitive).pbrMetallicRoughness ?? {}
  return colors_of(gltf, primitive).map((color) => color.map((band, k) => band * baseColorFactor[k]))
})

test('nodes are selected and excluded by name; the others keep their materials', async () => {
  const all = lit_nodes((await baked('cornell_box.glb')).gltf)
  assert.ok(all.length >= 5, all.join())
  const [first, second] = all
  assert.deepEqual(lit_nodes((await baked('cornell_box.glb', '--select', first, '--select', second)).gltf), [first, second])
  assert.deepEqual(lit_nodes((await baked('cornell_box.glb', '--exclude', first)).gltf), all.slice(1))
  const { gltf, report } = await baked('cornell_box.glb', '--select', `${first.slice(0, -1)}?`)
  assert.ok(lit_nodes(gltf).includes(first))
  assert.ok(report.bakedTriangles > 0 && report.bakedTriangles < report.outputTriangles)
  const input = read_gltf(test_asset('cornell_box.glb'))
  primitives_of_scene(input).forEach(([node, primitive], k) => {
    if (lit_nodes(gltf).includes(name_of(input, node))) return
    assert.deepEqual(material_of(gltf, primitives_of_scene(gltf)[k][1]), material_of(input, primitive))
  })
})

test('what does not receive light still casts shadows and sends it', async () => {
  const colors = (gltf, node) => primitives_of_scene(gltf).filter(([n]) => name_of(gltf, n) === node)
    .flatMap(([, primitive]) => colors_of(gltf, primitive))
  const { gltf } = await baked('cornell_box.glb', '--exposure', 1)
  const [first] = lit_nodes(gltf)
  const alone = await baked('cornell_box.glb', '--exposure', 1, '--select', first)
  assert.deepEqual(colors(alone.gltf, first), colors(gltf, first))
})

test('a name that no node has is a mistake', () => {
  for (const option of ['--select', '--exclude']) {
    const { code, lines } = run(test_asset('cornell_box.glb'), path.join(folder, 'no.glb'), '--progress', 'none', option, 'nobody')
    assert.equal(code, 2)
    assert.deepEqual(lines, [`gltf-radiosity: error: ${option}: no node of the scene is called "nobody"`])
  }
  const { code, lines } = run(test_asset('cornell_box.glb'), path.join(folder, 'no.glb'), '--progress', 'none', '--exclude', '*')
  assert.equal(code, 1, 'nothing is left to bake')
  assert.match(lines.join(), /nothing to bake/)
})

test('direct and indirect light add up to both', async () => {
  const options = ['--exposure', 0.05, '--fit', 'interpolate']
  const parts = []
  for (const part of ['both', 'direct', 'indirect']) {
    const { gltf, report } = await baked('cornell_box.glb', ...options, '--bake', part)
    assert.equal(report.light, part)
    parts.push(shown(gltf).flatMap((color) => color.slice(0, 3)))
  }
  const [both, direct, indirect] = parts
  assert.ok(mean(direct) > 0 && mean(indirect) > 0.02 * mean(direct))
  both.forEach((value, k) => {
    if (direct[k] < 1) assert.ok(Math.abs(direct[k] + indirect[k] - value) < 1e-4, `${direct[k]} + ${indirect[k]} is not ${value}`)
  })
})

test('verify compares what shows all light by itself, and says so of the rest', () => {
  const output = path.join(folder, 'part.glb')
  for (const [options, why] of [[['--bake', 'direct'], /only direct light/], [['--target', 'keep'], /lit by the engine/]]) {
    bake(test_asset('cornell_box.glb'), output, ...cheapest, '--refine', 'none', ...options)
    const { code, lines } = run('verify', test_asset('cornell_box.glb'), output, '--progress', 'none')
    assert.equal(code, 1)
    assert.equal(lines.length, 1)
    assert.match(lines[0], why)
  }
})

test('colours scaled to the whole range show the same with their factors', async () => {
  const plain = shown((await baked('cornell_box.glb', '--exposure', 0.02)).gltf)
  const { gltf } = await baked('cornell_box.glb', '--exposure', 0.02, '--scale-to-factor')
  shown(gltf).forEach((color, v) => color.forEach((band, k) => assert.ok(Math.abs(band - plain[v][k]) < 1e-6)))
  for (const [, primitive] of primitives_of_scene(gltf)) {
    const most = Math.max(...colors_of(gltf, primitive).map((color) => Math.max(...color.slice(0, 3))))
    assert.ok(Math.abs(most - 1) < 1e-6, `up to ${most}`)
  }
})

test('verify sees no difference between colours scaled or not', () => {
  const output = path.join(folder, 'verified.glb')
  const [plain, scaled] = [[], ['--scale-to-factor']].map((options) => {
    bake(test_asset('cornell_box.glb'), output, ...cheapest, '--refine', 'none', ...options)
    const { code, stdout, stderr } = run('verify', test_asset('cornell_box.glb'), output, '--points', 100, '--max-samples', 64,
      '--progress', 'none', '--json', '-')
    assert.equal(code, 0, stderr)
    return JSON.parse(stdout)
  })
  assert.equal(scaled.clippedShare, plain.clippedShare)
  assert.ok(Math.abs(scaled.relativeRmse - plain.relativeRmse) < 1e-4)
})

test('8 bits scaled to the range are nearer to the truth in the dark', async () => {
  const dark = ['--exposure', 0.02]
  const truth = shown((await baked('cornell_box.glb', ...dark)).gltf).flat()
  const error = async (...options) => mean(shown((await baked('cornell_box.glb', ...dark, '--color-type', 'u8', ...options)).gltf)
    .flat().map((value, k) => Math.abs(value - truth[k])))
  const [plain, scaled] = [await error(), await error('--scale-to-factor')]
  assert.ok(scaled < 0.5 * plain, `${scaled} and ${plain}`)
})

test('materials that are kept stay as they are, and COLOR_0 is light alone', async () => {
  const { gltf } = await baked('cornell_box.glb', '--target', 'keep')
  const input = read_gltf(test_asset('cornell_box.glb'))
  assert.deepEqual(gltf.json.materials, input.json.materials)
  for (const [, primitive] of primitives_of_scene(gltf)) assert.notEqual(primitive.attributes.COLOR_0, undefined)
})

test('the radiance attribute goes on where COLOR_0 is clamped', async () => {
  const { gltf } = await baked('cornell_box.glb', '--exposure', 10, '--radiance-attribute', 'LIGHT')
  let beyond = 0
  for (const [, primitive] of primitives_of_scene(gltf)) {
    const light = read_accessor(gltf, primitive.attributes._LIGHT)
    colors_of(gltf, primitive).forEach((color, v) => light[v].forEach((band, k) => {
      assert.ok(Math.abs(Math.min(band, 1) - color[k]) < 1e-6)
      beyond += band > 1
    }))
  }
  assert.ok(beyond > 0)
  const output = path.join(folder, 'again.glb')
  bake(test_asset('cornell_box.glb'), output, ...cheapest, '--refine', 'none', '--target', 'keep', '--radiance-attribute', '_LIGHT')
  const { code, lines } = run(output, path.join(folder, 'no.glb'), '--progress', 'none', '--radiance-attribute', 'LIGHT')
  assert.equal(code, 2)
  assert.match(lines.join(), /meshes\[\d+\]\.primitives\[0\] has an attribute _LIGHT already/)
})

test('--strip-lights leaves no light in the output, and the colours are the same', async () => {
  for (const scene of ['lights_all_kinds.glb', 'image_based_light.glb']) {
    const colors = (gltf) => primitives_of_scene(gltf).map(([, primitive]) => colors_of(gltf, primitive))
    const [plain, stripped] = [(await baked(scene)).gltf, (await baked(scene, '--strip-lights')).gltf]
    assert.deepEqual(colors(stripped), colors(plain))
    assert.doesNotMatch(JSON.stringify(stripped.json), /KHR_lights_punctual|EXT_lights_image_based/)
    assert.match(JSON.stringify(plain.json), /KHR_lights_punctual|EXT_lights_image_based/)
  }
})

test('engines choose how colours are written, and options win over them', async () => {
  const u8 = 5121, u16 = 5123, float = 5126
  const written = async (...options) => {
    const { gltf, report } = await baked('cornell_box.glb', '--exposure', 0.02, ...options)
    const [[, primitive]] = primitives_of_scene(gltf)
    const scaled = material_of(gltf, primitive).pbrMetallicRoughness.baseColorFactor !== undefined
    return [gltf.json.accessors[primitive.attributes.COLOR_0].componentType, scaled, report.colorType]
  }
  assert.deepEqual(await written(), [float, false, 'float'])
  for (const engine of ['three', 'babylon', 'unity']) assert.deepEqual(await written('--engine', engine), [u16, false, 'u16'])
  for (const engine of ['unreal', 'blender']) assert.deepEqual(await written('--engine', engine), [u16, true, 'u16'])
  assert.deepEqual(await written('--engine', 'godot'), [u8, true, 'u8'])
  assert.deepEqual(await written('--engine', 'godot', '--color-type', 'float', '--no-scale-to-factor'), [float, false, 'float'])
  const { report } = await baked('cornell_box.glb', '--engine', 'godot', '--draco')
  assert.deepEqual([report.compression, report.warnings.some(({ code }) => code === 'engine-cannot-read')], ['draco', true])
})
