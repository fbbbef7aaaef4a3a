// The page's own text -> a glTF -> objects of three.js, with no network.
import { LoadingManager } from 'three'
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js'
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js'
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js'
import { baked_primitives } from './baked_primitives.js'

function bytes_of_base64(text) {
  const characters = atob(text)
  const bytes = new Uint8Array(characters.length)
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i)
  return bytes
}

// The bytes that the page carries under a name, in pieces: no string holds a large file. Their text leaves the page.
function carried_bytes(name) {
  const pieces = [...document.querySelectorAll(`script[data-part="${name}"]`)].map((element) => {
    element.remove()
    return bytes_of_base64(element.textContent)
  })
  const bytes = new Uint8Array(pieces.reduce((sum, piece) => sum + piece.length, 0))
  let end = 0
  for (const piece of pieces) {
    bytes.set(piece, end)
    end += piece.length
  }
  return bytes
}

export const packed_model = () => carried_bytes('model')

// DRACOLoader asks for two files; they are in the page if the scene needs them.
function draco_loader() {
  const manager = new LoadingManager()
  const urls = {}
  manager.setURLModifier((url) => {
    const name = url.endsWith('.wasm') ? 'draco_wasm' : 'draco_js'
    return (urls[name] ??= URL.createObjectURL(new Blob([carried_bytes(name)])))
  })
  return new DRACOLoader(manager).setDecoderPath('draco/')
}

// { scene, cameras, primitives (baked_primitives.js), signature (asset.extras.radiosity), size (bytes) }
export async function unpack(glb) {
  const loader = new GLTFLoader().setDRACOLoader(draco_loader()).setMeshoptDecoder(MeshoptDecoder)
  const gltf = await loader.parseAsync(glb.buffer, '')
  const signature = gltf.asset.extras?.radiosity ?? {}
  // The colours hold the light of the scene's own lamps already.
  const lights = []
  gltf.scene.traverse((object) => { if (object.isLight) lights.push(object) })
  for (const light of lights) light.removeFromParent()
  gltf.scene.updateMatrixWorld(true)
  const in_scene = (camera) => { let top = camera; while (top.parent) top = top.parent; return top === gltf.scene }
  const cameras = gltf.cameras.filter((camera) => camera.isPerspectiveCamera && in_scene(camera))
  return { scene: gltf.scene, cameras, primitives: baked_primitives(gltf.scene, signature), signature, size: glb.length }
}
