// node draw_pictures.mjs IN OUT PICTURE.png [--eye x,y,z] [--at x,y,z] [--fov DEGREES] [--size W,H]
//
// Before and after, side by side: IN under a headlight, OUT as baked. The camera is the first one of each file unless
// --eye says otherwise.
import fs from 'node:fs'
import { parseArgs } from 'node:util'
import { open_viewer, url_of } from './browser.mjs'

const options = Object.fromEntries(['eye', 'at', 'fov', 'size'].map((name) => [name, { type: 'string' }]))
const { values, positionals } = parseArgs({ allowPositionals: true, options })
const [source, baked, picture] = positionals
if (!picture) throw new Error('usage: node draw_pictures.mjs IN OUT PICTURE.png [options]')
const numbers = (text) => text?.split(',').map(Number)

const [width, height] = numbers(values.size ?? '640,640')
const view = { width, height, eye: numbers(values.eye), at: numbers(values.at), fov: values.fov && Number(values.fov) }
const { page, close } = await open_viewer()
const draw = (args) => window.viewer.before_and_after(...args)
const url = await page.evaluate(draw, [url_of(source), url_of(baked), view])
fs.writeFileSync(picture, Buffer.from(url.split(',')[1], 'base64'))
await close()
