// The controls beside the picture: what people move -> what is drawn. Names come from files: they are only ever set as text.
import { Color } from 'three'
import { lux_at, stops } from './illuminance.js'

const by_id = (id) => document.getElementById(id)
const count = (number) => number.toLocaleString('en')

// Three digits that matter.
const short = (number) => (number >= 100 ? count(Math.round(number)) : `${Number(number.toPrecision(3))}`)

// A slider with its number beside it.
function on_slide(input, text_of, changed) {
  const output = input.parentElement.querySelector('output')
  const update = () => {
    output.textContent = text_of(input.valueAsNumber)
    changed(input.valueAsNumber)
  }
  input.addEventListener('input', update)
  return update
}

function facts({ scene, size, signature }) {
  let [triangles, vertices] = [0, 0]
  scene.traverse(({ isMesh, geometry }) => {
    if (!isMesh) return
    triangles += (geometry.index ?? geometry.attributes.position).count / 3
    vertices += geometry.attributes.position.count
  })
  const light = { direct: ', direct light only', indirect: ', indirect light only' }[signature.light] ?? ''
  const clipped = signature.clipped > 0.0005 ? `, ${(100 * signature.clipped).toFixed(1)} % of it clipped` : ''
  const exposure = signature.exposure === undefined ? '' : `\nBaked at ${short(signature.exposure)} m²/cd${clipped}${light}`
  return `${count(triangles)} triangles, ${count(vertices)} vertices, ${(size / 1e6).toFixed(size < 1e7 ? 1 : 0)} MB${exposure}`
}

// One row per group of lights: { element, weight() as linear [r, g, b], reset() }
function light_row(name, changed) {
  const element = document.createElement('li')
  element.innerHTML = `<span class="name"></span><input type="color" value="#ffffff" title="Colour">
    <input type="range" min="0" max="2" step="0.01" value="1"><output></output>`
  const [color, dimmer] = element.querySelectorAll('input')
  element.dataset.group = element.querySelector('.name').textContent = element.querySelector('.name').title = name
  color.setAttribute('aria-label', `Colour of ${name}`)
  dimmer.setAttribute('aria-label', `Strength of ${name}`)
  const update = on_slide(dimmer, (value) => `${Math.round(100 * value)} %`, changed)
  color.addEventListener('input', changed)
  const weight = () => new Color(color.value).multiplyScalar(dimmer.valueAsNumber).toArray()
  const reset = () => {
    Object.assign(color, { value: '#ffffff' })
    Object.assign(dimmer, { value: 1 })
    update()
  }
  return { element, weight, reset }
}

function draw_legend(lux) {
  by_id('scale').style.background = `linear-gradient(to right, ${stops.map((stop) => `rgb(${stop})`).join(', ')})`
  const places = lux.logarithmic ? [0, 1 / 3, 2 / 3, 1] : [0, 0.25, 0.5, 0.75, 1]
  by_id('ticks').replaceChildren(...places.map((place) => {
    const tick = document.createElement('span')
    tick.style.left = `${100 * place}%`
    tick.textContent = (place === 1 ? '≥ ' : '') + short(lux_at(place, lux))
    return tick
  }))
}

// Clicks, but not the ends of drags.
function on_click(canvas, clicked) {
  let start = null
  canvas.addEventListener('pointerdown', (event) => { start = [event.clientX, event.clientY] })
  canvas.addEventListener('pointerup', (event) => {
    if (start && Math.hypot(event.clientX - start[0], event.clientY - start[1]) < 4) clicked(event.offsetX, event.offsetY)
    start = null
  })
}

function add_lights(names, picture) {
  const update = () => picture.set({ weights: rows.map(({ weight }) => weight()) })
  const rows = names.map((name) => light_row(name, update))
  by_id('lights').append(...rows.map(({ element }) => element))
  return () => rows.forEach(({ reset }) => reset())
}

function add_cameras(picture) {
  const select = by_id('camera')
  select.append(...picture.views.map(({ name }) => new Option(name)))
  by_id('camera_row').hidden = picture.views.length < 2
  select.addEventListener('change', () => picture.look_from(picture.views[select.selectedIndex]))
  return () => {
    select.selectedIndex = 0
    picture.look_from(picture.views[0])
  }
}

// The scale of the false colours: from a thousandth of what is usual to a thousand times as much.
function add_lux_scale(picture) {
  const [input, logarithmic] = [by_id('lux_end'), by_id('lux_log')]
  const end_at = (place) => Number((picture.lux_end * 10 ** (6 * place - 3)).toPrecision(2))
  const update = on_slide(input, (place) => `${short(end_at(place))} lx`, (place) => {
    const lux = { end: end_at(place), logarithmic: logarithmic.checked }
    draw_legend(lux)
    picture.set({ lux })
  })
  logarithmic.addEventListener('change', update)
  return () => {
    Object.assign(input, { value: 0.5 })
    Object.assign(logarithmic, { checked: false })
    update()
  }
}

function add_looks(picture) {
  const inputs = [...document.querySelectorAll('input[name="look"]')]
  const [compare, wireframe, divider] = [by_id('compare'), by_id('wireframe'), by_id('divider')]
  const update = () => {
    const look = inputs.find(({ checked }) => checked).value
    by_id('legend').hidden = by_id('lux_range').hidden = look !== 'lux'
    picture.set({ look, wireframe: wireframe.checked })
  }
  const split = on_slide(compare, (percent) => `${percent} %`, (percent) => {
    divider.hidden = percent === 0 || percent === 100
    divider.style.left = `${percent}%`
    picture.set({ compare: percent / 100 })
  })
  for (const input of [...inputs, wireframe]) input.addEventListener('change', update)
  return () => {
    inputs[0].checked = true
    Object.assign(compare, { value: 0 })
    Object.assign(wireframe, { checked: false })
    update()
    split()
  }
}

function add_exposure(picture) {
  const input = by_id('exposure')
  const update = on_slide(input, (stops) => `${stops > 0 ? '+' : ''}${stops.toFixed(1)} EV`,
    (stops) => picture.set({ brightness: 2 ** stops }))
  return () => {
    Object.assign(input, { value: 0 })
    update()
  }
}

export function create_panel(model, picture) {
  by_id('panel').hidden = false
  by_id('facts').textContent = facts(model)
  const { storage, groups } = model.signature.lightGroups ?? {}
  const names = ['morph', 'attributes', 'file'].includes(storage) ? groups.map(({ name }) => name) : ['All light']
  const resets = [add_looks(picture), add_cameras(picture), add_exposure(picture), add_lux_scale(picture), add_lights(names, picture)]
  for (const reset of resets) reset()
  by_id('reset').addEventListener('click', () => resets.forEach((reset) => reset()))
  on_click(by_id('picture'), (x, y) => {
    const lux = picture.lux_at(x, y)
    by_id('reading').textContent = lux === undefined ? 'Click a surface to read it' : lux === null ? 'Not known here' : `Here: ${short(lux)} lx`
  })
}
