// `gltf-radiosity relight`: other lights and other reflectances for a bake that has saved its transport.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { colors_of } from './baked.mjs'
import { bake, run, temporary_folder, test_asset } from './command_line.mjs'
import { primitives_of_scene, read_gltf, to_glb } from './gltf_file.mjs'
import { valid_report } from './report_schema.mjs'

const folder = temporary_folder()
const target = (name) => path.join(folder, name)
// One mesh, one exposure, and next to nothing left unshot: then two bakes differ in their light alone.
const same_mesh = ['--refine', 'uniform', '--patch-size', 0.15, '--exposure', 0.05, '--residual', 0.00001, '--quality', 'draft']

function bake_with_transport(scene, name, ...options) {
  const report = bake(scene, target(`${name}.glb`), '--save-transport', target(`${name}.rad`), ...same_mesh, ...options)
  return { scene, glb: target(`${name}.glb`), rad: target(`${name}.rad`), report }
}

function relight(rad, output, ...options) {
  const { code, stdout, stderr } = run('relight', rad, output, '--json', '-', ...options)
  assert.equal(code, 0, stderr)
  return valid_report(stdout, 'relight')
}

// A copy of a .glb with other JSON.
function edited(scene, name, edit) {
  const { json, buffers } = read_gltf(scene)
  edit(json)
  fs.writeFileSync(target(name), to_glb(json, buffers[0]))
  return target(name)
}

const material = (json, name) => json.materials.find((one) => one.name === name)
function emit(json, name, luminance) {
  const strength = Math.max(...luminance)
  Object.assign(material(json, name), { emissiveFactor: luminance.map((band) => band / strength) })
  material(json, name).extensions = { KHR_materials_emissive_strength: { emissiveStrength: strength } }
  json.extensionsUsed = [...new Set([...(json.extensionsUsed ?? []), 'KHR_materials_emissive_strength'])]
}

const all_colors = (file) => {
  const gltf = read_gltf(file)
  const primitives = primitives_of_scene(gltf).map(([, primitive]) => primitive)
  return primitives.filter(({ attributes }) => attributes.COLOR_0 !== undefined).flatMap((one) => colors_of(gltf, one))
}

// The largest and the root mean square difference of the colours, relative to their mean.
function difference(file, other) {
  const [a, b] = [file, other].map(all_colors)
  assert.equal(a.length, b.length)
  let [largest, squares, sum, count] = [0, 0, 0, 0]
  a.forEach((color, v) => color.slice(0, 3).forEach((band, k) => {
    const apart = Math.abs(band - b[v][k])
    largest = Math.max(largest, apart)
    squares += apart * apart
    sum += b[v][k]
    count += 1
  }))
  return { largest: largest / (sum / count), rms: Math.sqrt(squares / count) / (sum / count) }
}

function assert_same_light(file, full) {
  const { largest, rms } = difference(file, full)
  assert.ok(rms < 0.0005 && largest < 0.001, `${file}: root mean square ${rms}, largest ${largest}`)
}

const room = bake_with_transport(test_asset('textured_interior.glb'), 'room')
const box = bake_with_transport(test_asset('cornell_box.glb'), 'box')
const lights = bake_with_transport(test_asset('lights_all_kinds.glb'), 'lights', '--sky', '0.5,0.2,0', '--sun', '30,40,2')

test('nothing changed gives the bake again', () => {
  for (const { rad, glb } of [room, box, lights]) {
    relight(rad, target('same.glb'))
    assert.ok(difference(target('same.glb'), glb).largest < 0.0002, rad)
    const [same, baked] = [target('same.glb'), glb].map((file) => read_gltf(file).json)
    for (const json of [same, baked]) delete json.asset.extras.radiosity
    assert.deepEqual(same, baked)
  }
})

test('saving the transport changes nothing about the bake', () => {
  bake(room.scene, target('plain.glb'), ...same_mesh)
  assert.ok(fs.readFileSync(target('plain.glb')).equals(fs.readFileSync(room.glb)))
})

test('lamps of other colours light a room as a bake with them does', () => {
  const names = read_gltf(room.scene).json.materials.filter(({ emissiveFactor }) => emissiveFactor).map(({ name }) => name)
  assert.deepEqual(names.sort(), ['lamp', 'sign'])
  relight(room.rad, target('relit.glb'), '--emissive', 'lamp=3,9,12', '--emissive', 'sign=5,0.5,2')
  const scene = edited(room.scene, 'other_lamps.glb', (json) => {
    emit(json, 'lamp', [3, 9, 12])
    emit(json, 'sign', [5, 0.5, 2])
  })
  bake(scene, target('full.glb'), ...same_mesh)
  assert_same_light(target('relit.glb'), target('full.glb'))
})

test('punctual lights, the sun and the sky are changed by name, from a band that had no light too', () => {
  const [first, second] = read_gltf(lights.scene).json.extensions.KHR_lights_punctual.lights
  relight(lights.rad, target('relit.glb'), '--light', `${first.name}=0.2,0.9,1,${3 * first.intensity}`, '--light',
    `${second.name}=7`, '--light', 'sun=1,0.5,0.25,3', '--sky', '0.1,0.4,0.8')
  const [light] = read_gltf(target('relit.glb')).json.extensions.KHR_lights_punctual.lights
  assert.deepEqual(light.color.map((band) => Math.round(light.intensity * band * 1000)), [0.6, 2.7, 3].map((band) => Math.round(first.intensity * band * 1000)))
  const scene = edited(lights.scene, 'other_lights.glb', (json) => {
    const own = json.extensions.KHR_lights_punctual.lights
    Object.assign(own[0], { color: [0.2, 0.9, 1], intensity: 3 * first.intensity })
    own[1].intensity = 7
    for (const one of own.filter(({ name }) => name === 'sun')) Object.assign(one, { color: [1, 0.5, 0.25], intensity: 3 })
  })
  // The sun of the options has no colour there, so its light is compared where it is white.
  relight(lights.rad, target('white_sun.glb'), '--light', `${first.name}=0.2,0.9,1,${3 * first.intensity}`, '--light',
    `${second.name}=7`, '--sky', '0.1,0.4,0.8')
  const white = edited(scene, 'white_sun_scene.glb', (json) => {
    const original = read_gltf(lights.scene).json.extensions.KHR_lights_punctual.lights
    json.extensions.KHR_lights_punctual.lights.forEach((one, i) => one.name === 'sun' && Object.assign(one, original[i]))
  })
  bake(white, target('full.glb'), ...same_mesh, '--sky', '0.1,0.4,0.8', '--sun', '30,40,2')
  assert_same_light(target('white_sun.glb'), target('full.glb'))
  assert.ok(difference(target('relit.glb'), target('white_sun.glb')).largest > 0.1)
})

test('walls of another colour reflect another light, where they had none in a band too', () => {
  const painted = read_gltf(box.scene).json.materials.map(({ name }) => name).filter((name) => /red|white/i.test(name))
  assert.equal(painted.length, 2)
  const [one, other] = painted
  relight(box.rad, target('relit.glb'), '--reflectance', `${one}=0,0.2,0.8`, '--reflectance', `${other}=0.9,0.9,0.3`, '--emissive', `${emitter(box.scene)}=2`)
  const scene = edited(box.scene, 'repainted.glb', (json) => {
    material(json, one).pbrMetallicRoughness.baseColorFactor = [0, 0.2, 0.8, 1]
    material(json, other).pbrMetallicRoughness.baseColorFactor = [0.9, 0.9, 0.3, 1]
    const lamp = material(json, emitter(box.scene))
    lamp.extensions.KHR_materials_emissive_strength.emissiveStrength *= 2
  })
  bake(scene, target('full.glb'), ...same_mesh)
  assert_same_light(target('relit.glb'), target('full.glb'))
  bake_with_transport(scene, 'painted')
  relight(target('painted.rad'), target('back.glb'), '--reflectance', `${one}=${factor(box.scene, one)}`, '--reflectance',
    `${other}=${factor(box.scene, other)}`, '--emissive', `${emitter(box.scene)}=0.5`)
  assert_same_light(target('back.glb'), box.glb)
})

const emitter = (scene) => read_gltf(scene).json.materials.find(({ emissiveFactor = [0] }) => Math.max(...emissiveFactor) > 0).name
const factor = (scene, name) => material(read_gltf(scene).json, name).pbrMetallicRoughness.baseColorFactor.slice(0, 3).join(',')

test('materials that stay lit get the new values too', () => {
  const { rad } = bake_with_transport(box.scene, 'kept', '--target', 'keep')
  const lamp = emitter(box.scene)
  relight(rad, target('kept_relit.glb'), '--emissive', `${lamp}=4,2,1`)
  const { emissiveFactor, extensions } = material(read_gltf(target('kept_relit.glb')).json, lamp)
  assert.deepEqual(emissiveFactor, [1, 0.5, 0.25])
  assert.equal(extensions.KHR_materials_emissive_strength.emissiveStrength, 4)
})

test('small integers, compressed geometry and another kind of file are relit as well', () => {
  const small = bake_with_transport(box.scene, 'small', '--color-type', 'u8', '--meshopt')
  relight(small.rad, target('small_relit.glb'))
  assert.ok(fs.readFileSync(target('small_relit.glb')).equals(fs.readFileSync(small.glb)))
  relight(box.rad, target('relit.gltf'), '--exposure', 'auto')
  const [{ uri }] = read_gltf(target('relit.gltf')).json.buffers
  assert.ok(fs.existsSync(target(uri)))
})

test('any number of threads gives the same bytes', () => {
  for (const threads of [1, 3]) bake_with_transport(box.scene, `threads${threads}`, '--threads', threads)
  assert.ok(fs.readFileSync(target('threads1.rad')).equals(fs.readFileSync(target('threads3.rad'))))
  const [one, three] = [1, 3].map((threads) => {
    relight(target('threads1.rad'), target('thread.glb'), '--reflectance', 'white=0.5,0.5,0.5', '--threads', threads)
    return fs.readFileSync(target('thread.glb'))
  })
  assert.ok(one.equals(three))
})

test('a transport is refused if the geometry of its source has changed, not if its light has', () => {
  const brighter = edited(box.scene, 'brighter.glb', (json) => emit(json, emitter(box.scene), [1, 2, 3]))
  relight(box.rad, target('fresh.glb'), '--source', brighter)
  const moved = edited(box.scene, 'moved.glb', (json) => { json.nodes[0].translation = [0, 0, 0.125] })
  const { code, lines } = run('relight', box.rad, target('stale.glb'), '--source', moved)
  assert.equal(code, 1)
  assert.equal(lines.length, 1)
  assert.match(lines[0], /moved.glb: its geometry is not that of the transport/)
  assert.ok(!fs.existsSync(target('stale.glb')))
})

test('a transport that is damaged, cut off or something else is refused', () => {
  const bytes = fs.readFileSync(box.rad)
  const damaged = [
    ['empty', Buffer.alloc(0)], ['cut', bytes.subarray(0, bytes.length - 100)], ['scene', fs.readFileSync(box.scene)],
    ...[0.01, 0.2, 0.4].map((share) => {
      const copy = Buffer.from(bytes)
      for (let i = 0; i < 64; ++i) copy[Math.floor(share * bytes.length) + i] ^= 0x55
      return [`flipped_${share}`, copy]
    }),
  ]
  for (const [name, content] of damaged) {
    fs.writeFileSync(target(`${name}.rad`), content)
    const { code, lines } = run('relight', target(`${name}.rad`), target('damaged.glb'), '--reflectance', 'white=0.5,0.5,0.5')
    assert.equal(code, 1, `${name}: ${lines}`)
    assert.equal(lines.length, 1)
    assert.ok(!fs.existsSync(target('damaged.glb')))
  }
})

test('a name that nothing bears is refused with the names there are', () => {
  const refused = [
    [['--light', 'no such=1'], /--light: no light is called 'no such'; there are: .*point.*spot/],
    [['--emissive', 'no such=2'], /--emissive: no material that emits light is called 'no such'; there is none/],
    [['--reflectance', 'no such=1,1,1'], /--reflectance: no material is called 'no such'; there are: /],
  ]
  for (const [options, expected] of refused) {
    const { code, lines } = run('relight', lights.rad, target('refused.glb'), ...options)
    assert.equal(code, 2)
    assert.match(lines[0], expected)
  }
  const without_sky = run('relight', box.rad, target('refused.glb'), '--sky', '1,1,1')
  assert.equal(without_sky.code, 2)
  assert.match(without_sky.lines[0], /--sky: the bake had no sky/)
  assert.ok(!fs.existsSync(target('refused.glb')))
})

test('where memory was short, lights can be changed, but not what surfaces reflect', () => {
  const { rad, report } = bake_with_transport(box.scene, 'short', '--max-memory', '64M', '--patch-size', 0.02)
  assert.equal(report.transportReflectance, false)
  assert.ok(report.warnings.some(({ code }) => code === 'transport-without-exchange'))
  relight(rad, target('short.glb'), '--emissive', `${emitter(box.scene)}=2`)
  const { code, lines } = run('relight', rad, target('refused.glb'), '--reflectance', 'white=0.5,0.5,0.5')
  assert.equal(code, 2)
  assert.match(lines[0], /--reflectance: the bake kept no form factors.*--max-memory/)
})

test('the report of the bake says what the transport holds', () => {
  assert.equal(room.report.transportBytes, fs.statSync(room.rad).size)
  assert.equal(room.report.transportSources, 2)
  assert.equal(room.report.transportReflectance, true)
  assert.ok(room.report.phases.some(({ name }) => name === 'transport'))
})

test('a transport needs what adds up', () => {
  for (const options of [['--solver', 'progressive'], ['--fit', 'interpolate']]) {
    const { code, lines } = run(box.scene, target('refused.glb'), '--save-transport', target('refused.rad'), ...options)
    assert.equal(code, 2)
    assert.match(lines[0], /--save-transport: needs --/)
  }
})
