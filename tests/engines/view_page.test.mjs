// The page of `gltf-radiosity view`, opened from the disk in a browser without a network: what is seen is what the file's
// numbers say, whatever is moved.
import assert from 'node:assert/strict'
import path from 'node:path'
import test from 'node:test'
import { bake, run, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { read_compressed } from '../end_to_end/compressed_file.mjs'
import { from_base64 } from './base64.mjs'
import { open_browser } from './browser.mjs'
import { mixed } from './mixed.mjs'
import { assert_pixels, difference, probes } from './probes.mjs'

const folder = temporary_folder()
const panel = 288
const [width, height] = [440, 320]  // of the picture
const to_linear = (code) => (code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4)

function baked(scene, ...options) {
  const output = path.join(folder, `${scene}${options.join('')}.glb`)
  bake(test_asset(`${scene}.glb`), output, '--quality', 'draft', '--refine', 'none', ...options)
  return output
}

function page_of(file, ...options) {
  const html = file.replace(/\.\w+$/, '.html')
  const { code, stderr } = run('view', file, '--html', html, '--progress', 'none', ...options)
  assert.equal(code, 0, stderr)
  return html
}

// RGBA bytes of the picture as the screen shows it, rows from the top, once what was asked for is drawn.
async function picture_of(page) {
  await page.evaluate(() => new Promise((drawn) => { requestAnimationFrame(() => requestAnimationFrame(drawn)) }))
  const png = await page.screenshot({ clip: { x: 0, y: 0, width, height } })
  return from_base64(await page.evaluate(async (url) => {
    const image = new Image()
    image.src = url
    await image.decode()
    const canvas = document.createElement('canvas')
    Object.assign(canvas, { width: image.width, height: image.height })
    const paper = canvas.getContext('2d')
    paper.drawImage(image, 0, 0)
    const { data } = paper.getImageData(0, 0, image.width, image.height)
    let text = ''
    for (let row = 0; row < image.height; ++row) {
      text += String.fromCharCode(...data.subarray(4 * row * image.width, 4 * (row + 1) * image.width))
    }
    return btoa(text)
  }, `data:image/png;base64,${png.toString('base64')}`))
}

// Moves a slider or a colour as a person would: the page hears of it.
const move = (page, selector, value) => page.locator(selector).fill(`${value}`)

// Where there is something: the page has a background of its own.
const seen = (gltf) => probes(gltf, width, height).filter(({ expected }) => expected.some((code) => code > 0))

// The same file with all its colours multiplied, in linear light.
function dimmed(file, factors) {
  const gltf = read_compressed(file)
  for (const { pbrMetallicRoughness: pbr } of gltf.json.materials) {
    pbr.baseColorFactor = (pbr.baseColorFactor ?? [1, 1, 1, 1]).map((factor, k) => factor * (factors[k] ?? 1))
  }
  return gltf
}

const pixel = (pixels, x, y) => pixels.slice(4 * (y * width + x), 4 * (y * width + x) + 3)
const most = (a, b) => a.reduce((largest, code, k) => Math.max(largest, Math.abs(code - b[k])), 0)

test('the page of a bake', async (t) => {
  const { open, close } = await open_browser({ width: width + panel, height })
  t.after(close)
  const shown = async (html) => {
    const { page, problems, requests } = await open(html)
    assert.deepEqual(problems, [])
    assert.deepEqual(requests, [], 'it needs a network')
    return page
  }
  const box = baked('cornell_box')
  const box_page = await shown(page_of(box))
  const untouched = await picture_of(box_page)

  await t.test('shows COLOR_0 as it was baked', () => {
    assert_pixels(untouched, seen(read_compressed(box)), { width, tolerance: 2, least_probes: 250 })
  })

  await t.test('a dimmer and a colour change every pixel as the numbers say', async () => {
    await move(box_page, '#lights input[type=range]', 0.5)
    await move(box_page, '#lights input[type=color]', '#ff8040')
    const factors = [255, 128, 64].map((code) => 0.5 * to_linear(code / 255))
    const expected = seen(dimmed(box, factors))
    assert_pixels(await picture_of(box_page), expected, { width, tolerance: 2, least_probes: 250 })
  })

  await t.test('a stop of exposure doubles the light', async () => {
    await box_page.click('#reset')
    await move(box_page, '#exposure', 1)
    assert_pixels(await picture_of(box_page), seen(dimmed(box, [2, 2, 2])), { width, tolerance: 2, least_probes: 250 })
  })

  await t.test('before and after stand beside each other', async () => {
    await box_page.click('#reset')
    await move(box_page, '#compare', 50)
    const split = await picture_of(box_page)
    const [left, right] = [[100, 200], [340, 200]]
    assert.deepEqual(pixel(split, ...right), pixel(untouched, ...right))
    assert.notDeepEqual(pixel(split, ...left), pixel(untouched, ...left))
    await box_page.click('input[value=unbaked]', { force: true })
    assert.notDeepEqual(pixel(await picture_of(box_page), ...right), pixel(untouched, ...right))
  })

  await t.test('a wireframe is drawn, and everything can be reset', async () => {
    await box_page.click('#reset')
    await box_page.click('#wireframe')
    assert.ok(most(await picture_of(box_page), untouched) > 30, 'lines')
    await box_page.click('#reset')
    assert.equal(most(await picture_of(box_page), untouched), 0)
  })

  await t.test('the ceiling lamp has no reading, the floor has', async () => {
    await box_page.click('input[value=lux]', { force: true })
    await box_page.click('#picture', { position: { x: width / 2, y: 45 } })
    assert.equal(await box_page.textContent('#reading'), 'Not known here')
    await box_page.click('#picture', { position: { x: width / 2, y: height - 12 } })
    assert.match(await box_page.textContent('#reading'), /^Here: [\d.]+ lx$/)
  })

  await t.test('a cube under an even sky of 1 cd/m2 receives pi lux, in numbers and in colour', async () => {
    const page = await shown(page_of(baked('unit_cube', '--sky', '1,1,1')))
    await page.click('input[value=lux]', { force: true })
    await move(page, '#lux_end', 0.55)
    const reading = async () => {
      await page.click('#picture', { position: { x: width / 2, y: height / 2 } })
      return Number(/[\d.]+/.exec(await page.textContent('#reading'))[0])
    }
    assert.ok(Math.abs(await reading() - Math.PI) < 0.02, `${await reading()} lx`)

    // Where the legend says that it lies.
    const [gradient, end] = await page.evaluate(() => [getComputedStyle(document.getElementById('scale')).backgroundImage,
      document.querySelector('#ticks span:last-child').textContent])
    const stops = [...gradient.matchAll(/rgb\((\d+), (\d+), (\d+)\)/g)].map(([, ...codes]) => codes.map(Number))
    const at = (Math.PI / Number(/[\d.]+/.exec(end)[0])) * (stops.length - 1)
    const low = stops[Math.floor(at)]
    const expected = low.map((code, k) => code + (at % 1) * (stops[Math.floor(at) + 1][k] - code))
    const found = pixel(await picture_of(page), width / 2, height / 2)
    assert.ok(difference(found, expected) < 4, `${found}, not ${expected}`)

    await move(page, '#lights input[type=range]', 0.5)
    assert.ok(Math.abs(await reading() - Math.PI / 2) < 0.01, `${await reading()} lx at half the light`)
  })

  await t.test('compressed files look the same', async () => {
    for (const compression of ['--draco', '--meshopt']) {
      const page = await shown(page_of(baked('cornell_box', compression)))
      const expected = seen(read_compressed(box))
      assert_pixels(await picture_of(page), expected, { width, tolerance: 2, least_probes: 250 })
      await page.close()
    }
  })

  await t.test('a textured interior is seen through the camera of the file', async () => {
    const file = baked('textured_interior', '--color-type', 'u16')
    const page = await shown(page_of(file))
    assert.equal(await page.inputValue('#camera'), 'corner')
    assert_pixels(await picture_of(page), seen(read_compressed(file)), { width, tolerance: 4, least_probes: 300 })
  })

  await t.test('each group of lights has a dimmer and a colour, with every storage', async () => {
    for (const storage of ['morph', 'attributes']) {
      const file = baked('textured_interior', '--light-groups', storage)
      const page = await shown(page_of(file))
      const names = await page.locator('#lights .name').allTextContents()
      assert.ok(names.length >= 2, `${names}`)
      await move(page, `#lights li[data-group="${names[0]}"] input[type=range]`, 0.25)
      await move(page, `#lights li[data-group="${names[1]}"] input[type=color]`, '#40ff80')
      const dimmers = { [names[0]]: [0.25, 0.25, 0.25], [names[1]]: [64, 255, 128].map((code) => to_linear(code / 255)) }
      const expected = seen(mixed(read_compressed(file), dimmers))
      assert_pixels(await picture_of(page), expected, { width, tolerance: 4, least_probes: 300 })
      await page.close()
    }
  })

  await t.test('a title is text, whatever it holds', async () => {
    const title = '</title></h1><script>window.hacked = true</script><img src=x onerror="window.hacked = true">&amp;'
    const page = await shown(page_of(baked('unit_cube'), '--title', title))
    assert.equal(await page.title(), title)
    assert.equal(await page.textContent('h1'), title)
    assert.equal(await page.evaluate(() => window.hacked), undefined)
  })
})
