// Runs in the page: draws a glTF as three.js shows it, without tone mapping.
import * as THREE from 'three'
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js'
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js'
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js'
import { as_base64 } from './base64.mjs'

const { renderer, canvas } = (() => {
  const canvas = document.createElement('canvas')
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: false, preserveDrawingBuffer: true })
  renderer.toneMapping = THREE.NoToneMapping
  return { renderer, canvas }
})()

const draco = new DRACOLoader().setDecoderPath('/three/examples/jsm/libs/draco/gltf/')
const load = (url) => new GLTFLoader().setDRACOLoader(draco).setMeshoptDecoder(MeshoptDecoder).loadAsync(url)

// The camera that `view` describes ({ eye, at, fov }), else the file's first one, else one that sees everything.
function camera_for(gltf, { width, height, eye, at, fov = 50 }) {
  const box = new THREE.Box3().setFromObject(gltf.scene)
  let camera = gltf.cameras[0]
  if (eye || !camera) {
    camera = new THREE.PerspectiveCamera(fov)
    const [centre, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3())]
    camera.position.copy(eye ? new THREE.Vector3(...eye) : centre.clone().addScaledVector(size, 0.9))
    camera.lookAt(at ? new THREE.Vector3(...at) : centre)
    Object.assign(camera, { near: size.length() / 1e4, far: size.length() * 10 })
  }
  camera.aspect = width / height
  camera.updateProjectionMatrix()
  return camera
}

function draw(gltf, view, lights = []) {
  const scene = new THREE.Scene()
  scene.add(gltf.scene, ...lights)
  renderer.setSize(view.width, view.height, false)
  renderer.render(scene, camera_for(gltf, view))
}

// RGBA bytes of the picture, rows from the top, in base64. `code` is run before, with what was loaded as `gltf` and `scene`.
export async function pixels_of(url, view, code = '') {
  const gltf = await load(url)
  new Function('gltf', 'scene', 'THREE', code)(gltf, gltf.scene, THREE)
  draw(gltf, view)
  const gl = renderer.getContext()
  const { width, height } = view
  const rows = new Uint8Array(4 * width * height)
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rows)
  const flipped = new Uint8Array(rows.length)
  for (let y = 0; y < height; ++y) {
    flipped.set(rows.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y))
  }
  return as_base64(flipped)
}

// A lamp at the camera and a little light from everywhere: how a modeller shows a scene that has no light yet.
function headlights(gltf, view) {
  const lamp = new THREE.DirectionalLight(0xffffff, 2)
  camera_for(gltf, view).getWorldPosition(lamp.position)
  new THREE.Box3().setFromObject(gltf.scene).getCenter(lamp.target.position)
  return [lamp, lamp.target, new THREE.AmbientLight(0xffffff, 0.6)]
}

// A picture of the source under a headlight beside one of the baked file without lights, as a PNG's data URL.
export async function before_and_after(source_url, baked_url, view) {
  const { width, height } = view
  const picture = document.createElement('canvas')
  Object.assign(picture, { width: 2 * width, height })
  const paper = picture.getContext('2d')
  const source = await load(source_url)
  source.scene.traverse((object) => { if (object.isLight) object.visible = false })
  draw(source, view, headlights(source, view))
  paper.drawImage(canvas, 0, 0)
  draw(await load(baked_url), view)
  paper.drawImage(canvas, width, 0)
  return picture.toDataURL('image/png')
}
