// The code of docs/relight.md, in the engines it is for: dimmers change pixels as the file's numbers say.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'
import { bake, sanitized, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { read_compressed } from '../end_to_end/compressed_file.mjs'
import { open_viewer } from './browser.mjs'
import { mixed } from './mixed.mjs'
import { assert_pixels, pixels_of, probes } from './probes.mjs'

const folder = temporary_folder()
const view = { width: 320, height: 240 }
const manual = fs.readFileSync(new URL('../../docs/relight.md', import.meta.url), 'utf8')

// The block of docs/relight.md that starts with ```js NAME
function code_of(name) {
  const block = new RegExp('^```js ' + name + '\\n(.*?)^```$', 'ms').exec(manual)
  assert.ok(block, `docs/relight.md has no code for ${name}`)
  return block[1]
}

function dimmable(storage, name, ...options) {
  const output = path.join(folder, `${storage}_${name}.glb`)
  const { lightGroups } = bake(test_asset('textured_interior.glb'), output, '--quality', 'draft', '--refine', 'none',
    '--light-groups', storage, ...options)
  assert.ok(lightGroups.length >= 2, `${lightGroups}`)
  return { output, names: lightGroups }
}

async function assert_dimmed(page, { output }, code, call, dimmers) {
  const pixels = await pixels_of(page, output, view, `${code}\n${call}`)
  const found = probes(mixed(read_compressed(output), dimmers), view.width, view.height)
  return assert_pixels(pixels, found, { ...view, tolerance: 4, least_probes: 250 })
}

const grey = (share) => [share, share, share]
const encodings = { float: [], u16: ['--color-type', 'u16'], u8: ['--color-type', 'u8'], draco: ['--draco'], meshopt: ['--meshopt'] }
// Each encoding in some engine: all of them in all would take minutes.
const tried = (...names) => names.slice(0, sanitized() ? 1 : names.length)

for (const [engine, html, names] of [['three', 'viewer.html', tried('float', 'draco', 'meshopt')], ['babylon', 'babylon.html', tried('float', 'u16')]]) {
  test(`${engine}: morph targets are dimmers`, async (t) => {
    const { page, close } = await open_viewer(html)
    t.after(close)
    for (const name of names) {
      await t.test(name, async () => {
        const file = dimmable('morph', name, ...encodings[name])
        const [first, second] = file.names
        if (name === 'float') await assert_dimmed(page, file, '', '', {})
        await assert_dimmed(page, file, code_of(`${engine} morph`),
          `set_dimmer(scene, ${JSON.stringify(first)}, 0.3); set_dimmer(scene, ${JSON.stringify(second)}, 0.6)`,
          { [first]: grey(0.3), [second]: grey(0.6) })
      })
    }
  })
}

test('three: attributes are mixed, in colour', async (t) => {
  const { page, close } = await open_viewer()
  t.after(close)
  for (const name of tried('float', 'u8')) {
    await t.test(name, async () => {
      const file = dimmable('attributes', name, ...encodings[name])
      const dimmers = { [file.names[0]]: [1, 0.5, 0.2], [file.names[1]]: [0, 0.3, 0.9] }
      await assert_dimmed(page, file, code_of('three attributes'), `set_dimmers(gltf, ${JSON.stringify(dimmers)})`, dimmers)
    })
  }
})
