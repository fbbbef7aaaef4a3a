// Runs in the page: draws a glTF as Babylon.js shows it, seen by the file's first camera.
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js'
import { as_base64 } from './base64.mjs'

// Decoders from this origin, in this thread. Babylon.js looks for meshoptimizer's among the globals.
const draco = '/three/examples/jsm/libs/draco/gltf'
Object.assign(BABYLON.DracoDecoder.DefaultConfiguration, {
  wasmUrl: `${draco}/draco_wasm_wrapper.js`, wasmBinaryUrl: `${draco}/draco_decoder.wasm`,
  fallbackUrl: `${draco}/draco_decoder.js`, numWorkers: 0,
})
window.MeshoptDecoder = MeshoptDecoder
BABYLON.MeshoptCompression.Configuration = { decoder: { url: 'data:text/javascript,' } }

const canvas = document.createElement('canvas')
// By default Babylon.js takes a power of 2.2 for sRGB: up to five codes off in the dark.
const engine = new BABYLON.Engine(canvas, false, { preserveDrawingBuffer: true, useExactSrgbConversions: true })

// RGBA bytes of the picture, rows from the top, as a plain array. `code` is run before, with what was loaded as `scene`.
export async function pixels_of(url, { width, height }, code = '') {
  Object.assign(canvas, { width, height })
  engine.setSize(width, height)
  const scene = new BABYLON.Scene(engine)
  scene.useRightHandedSystem = true
  scene.clearColor = new BABYLON.Color4(0, 0, 0, 1)
  await BABYLON.AppendSceneAsync(url, scene)
  scene.activeCamera = scene.cameras[0]
  for (const light of [...scene.lights]) light.dispose()
  new Function('scene', code)(scene)
  await scene.whenReadyAsync()
  scene.render()
  const rows = await engine.readPixels(0, 0, width, height)
  const flipped = new Uint8Array(4 * width * height)
  for (let y = 0; y < height; ++y) {
    flipped.set(new Uint8Array(rows.buffer, rows.byteOffset + 4 * width * y, 4 * width), 4 * width * (height - 1 - y))
  }
  scene.dispose()
  return as_base64(flipped)
}
