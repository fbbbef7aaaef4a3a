// Draws the scene, when something has changed: as engines show it, in sRGB, without tone mapping.
import { Color, DirectionalLight, HemisphereLight, MeshBasicMaterial, NoToneMapping, Raycaster, Scene, Vector2, WebGLRenderer } from 'three'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { mix } from './baked_primitives.js'
import { create_camera, views_of } from './cameras.js'
import { light_attribute, lux_of_color, usual_end, weighed } from './illuminance.js'
import { looks_of } from './looks.js'

function create_renderer(canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' })
  renderer.toneMapping = NoToneMapping
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2))
  return renderer
}

// What shows the unbaked look: a lamp at the camera and a little light from everywhere.
function headlights(camera) {
  const lamp = new DirectionalLight(0xffffff, 1.6)
  camera.add(lamp, lamp.target)
  lamp.target.position.set(0, 0, -1)
  return new HemisphereLight(0xffffff, 0x8a8a8a, 1.4)
}

// Lines over every triangle, made when they are first wanted.
function create_wires(primitives) {
  const material = new MeshBasicMaterial({ wireframe: true, color: 0x000000, transparent: true, opacity: 0.45 })
  return primitives.map(({ mesh }) => {
    const wires = mesh.clone(false)
    wires.material = material
    mesh.parent.add(wires)
    return wires
  })
}

// Objects that are not baked take part in no look but their own; they are shown dark in false colours.
function unbaked_meshes(scene, primitives) {
  const baked = new Set(primitives.map(({ mesh }) => mesh))
  const found = []
  scene.traverse((object) => { if ((object.isMesh || object.isLine || object.isPoints) && !baked.has(object)) found.push(object) })
  return found
}

// { views; lux_end, a good end of the scale; set(changes of the state); look_from(view); lux_at(x, y) }. The state: look, one of
// looks.js; compare, the share of the width that is unbaked; wireframe; brightness, a factor; weights, [r, g, b] of each group of
// lights; lux: { end, logarithmic }.
export function create_picture(canvas, { scene, cameras, primitives, signature }) {
  const renderer = create_renderer(canvas)
  const stage = new Scene()
  stage.background = new Color(0x101012)
  const camera = create_camera(scene)
  const ambient = headlights(camera)
  stage.add(scene, camera, ambient)
  const controls = new OrbitControls(camera, canvas)
  const views = views_of({ cameras, scene })
  const scale = { luxEnd: { value: 1 }, luxLogarithmic: { value: false } }
  const looks = primitives.map((primitive) => ({ primitive, ...looks_of(primitive, signature, scale) }))
  const others = unbaked_meshes(scene, primitives)
  const plain = new MeshBasicMaterial({ color: 0x5c5c5c, toneMapped: false })
  const own_material = new Map(others.map((object) => [object, object.material]))
  let wires = []
  const weights = (signature.lightGroups?.groups ?? ['all light']).map(() => [1, 1, 1])
  let state = { look: 'baked', compare: 0, wireframe: false, brightness: 1, weights, lux: { end: 1, logarithmic: false } }
  let waiting = false

  const show_as = (look) => {
    for (const entry of looks) entry.primitive.mesh.material = entry[look]
    for (const object of others) object.material = look === 'lux' && object.isMesh ? plain : own_material.get(object)
    ambient.visible = camera.children[0].visible = look === 'unbaked'
  }

  // The unbaked look on the left of the divider, the chosen one on the right.
  const draw = () => {
    waiting = false
    const { width, height } = renderer.getSize(new Vector2())
    const left = Math.round(width * state.compare)
    renderer.setScissorTest(left > 0)
    if (left > 0) {
      show_as('unbaked')
      renderer.setScissor(0, 0, left, height)
      renderer.render(stage, camera)
      renderer.setScissor(left, 0, width - left, height)
    }
    show_as(state.look)
    if (left < width) renderer.render(stage, camera)
  }
  const request = () => {
    if (waiting) return
    waiting = true
    requestAnimationFrame(draw)
  }

  const resize = () => {
    const { clientWidth: width, clientHeight: height } = canvas.parentElement
    renderer.setSize(width, height, false)
    camera.aspect = width / Math.max(height, 1)
    camera.updateProjectionMatrix()
    request()
  }

  // Several sets of colours are mixed; a single one is dimmed where it is shown.
  const weight_of = ({ sets }) => (sets ? [1, 1, 1] : state.weights[0])
  const lux_weights = (primitive) => lux_of_color(primitive, signature)?.map((lux, band) => lux * weight_of(primitive)[band])
  const dim = () => {
    mix(primitives, state.weights)
    for (const { primitive, baked, lux } of looks) {
      const [r, g, b] = weight_of(primitive)
      baked.color.setRGB(r, g, b).multiply(primitive.factor).multiplyScalar(state.brightness)
      lux.userData.lux_of_color.fromArray(lux_weights(primitive) ?? [0, 0, 0])
    }
  }

  const look_from = ({ eye, at, fov }) => {
    camera.position.copy(eye)
    camera.fov = fov
    camera.updateProjectionMatrix()
    controls.target.copy(at)
    controls.update()
    request()
  }

  // What is read at a pixel of the canvas: lux, null where it is not known, undefined where nothing is.
  const lux_at = (x, y) => {
    const { clientWidth: width, clientHeight: height } = canvas
    const ray = new Raycaster()
    ray.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), camera)
    const [hit] = ray.intersectObjects(primitives.map(({ mesh }) => mesh), false)
    if (!hit) return undefined
    const primitive = primitives.find(({ mesh }) => mesh === hit.object)
    const weights = lux_weights(primitive)
    if (!weights) return null
    const color = hit.object.geometry.attributes[light_attribute(primitive, signature)]
    const { face: { a, b, c }, barycoord } = hit
    return barycoord.x * weighed(weights, color, a) + barycoord.y * weighed(weights, color, b) + barycoord.z * weighed(weights, color, c)
  }

  const set = (changes) => {
    const before = state
    state = { ...state, ...changes }
    if (state.weights !== before.weights || state.brightness !== before.brightness) dim()
    scale.luxEnd.value = state.lux.end
    scale.luxLogarithmic.value = state.lux.logarithmic
    if (state.wireframe && wires.length === 0) wires = create_wires(primitives)
    for (const wire of wires) wire.visible = state.wireframe
    request()
  }

  controls.addEventListener('change', request)
  new ResizeObserver(resize).observe(canvas.parentElement)
  const lux_end = usual_end(primitives, signature)
  dim()
  resize()
  look_from(views[0])
  return { views, lux_end, set, look_from, lux_at }
}
