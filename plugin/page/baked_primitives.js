// What was baked, as the page needs it: the light of each primitive, one set of colours for each group of lights.
//
// Where the file keeps the groups apart (asset.extras.radiosity.lightGroups), COLOR_0 is mixed from their colours here and
// not on the graphics card: that knows no limit to their number, and whatever reads COLOR_0 sees the mixture.
import { BufferAttribute } from 'three'

// RGB floats of a colour attribute: [3 * count].
function linear_rgb(attribute) {
  const rgb = new Float32Array(3 * attribute.count)
  for (let i = 0; i < attribute.count; ++i) {
    rgb[3 * i] = attribute.getX(i)
    rgb[3 * i + 1] = attribute.getY(i)
    rgb[3 * i + 2] = attribute.getZ(i)
  }
  return rgb
}

// The attributes `_LIGHT_name` of the groups; GLTFLoader writes names of its own in small letters.
function sets_of_attributes(geometry, groups) {
  return groups.map(({ attribute }) => {
    const values = geometry.attributes[attribute.toLowerCase()]
    return values ? linear_rgb(values) : null
  })
}

// The morph targets of the groups, which are taken out: what is left of them moves vertices.
function sets_of_targets(mesh, groups) {
  const { morphAttributes } = mesh.geometry
  const targets = mesh.morphTargetDictionary
  const of_group = groups.map(({ target }) => targets[target])
  const sets = of_group.map((index) => (index === undefined ? null : linear_rgb(morphAttributes.color[index])))
  delete morphAttributes.color
  const stays = (_, index) => !of_group.includes(index)
  for (const semantic of Object.keys(morphAttributes)) morphAttributes[semantic] = morphAttributes[semantic].filter(stays)
  mesh.morphTargetInfluences = mesh.morphTargetInfluences.filter(stays)
  if (mesh.morphTargetInfluences.length === 0) mesh.geometry.morphAttributes = {}
  return sets
}

// Per group its colours, or null; null in all where there is only COLOR_0.
function sets_of(mesh, { storage, groups } = {}) {
  if (storage === 'attributes') return sets_of_attributes(mesh.geometry, groups)
  if (storage === 'morph' && mesh.geometry.morphAttributes.color) return sets_of_targets(mesh, groups)
  return null
}

// A COLOR_0 of floats that the sets can be mixed into; alpha as it was.
function make_mixable(geometry) {
  const old = geometry.attributes.color
  const mixed = new Float32Array(4 * old.count).fill(1)
  if (old.itemSize === 4) for (let i = 0; i < old.count; ++i) mixed[4 * i + 3] = old.getW(i)
  geometry.setAttribute('color', new BufferAttribute(mixed, 4))
}

// All that has colours: [{ mesh; factor, what COLOR_0 is multiplied by; reflectance, which is in COLOR_0, and emits, if the file
// says so; sets, RGB floats per group or null, null where the file holds one COLOR_0 for all light; mixes }]. Primitives that
// share their accessors share a geometry: one of them mixes it.
export function baked_primitives(scene, signature) {
  const primitives = []
  const known = new Map()
  scene.traverse((mesh) => {
    if (!mesh.isMesh || !mesh.geometry.attributes.color) return
    const is_new = !known.has(mesh.geometry)
    if (is_new) known.set(mesh.geometry, sets_of(mesh, signature.lightGroups))
    const sets = known.get(mesh.geometry)
    if (is_new && sets) make_mixable(mesh.geometry)
    const { reflectance, emits = false } = mesh.geometry.userData.radiosity ?? {}
    primitives.push({ mesh, factor: mesh.material.color.clone(), reflectance, emits, sets, mixes: is_new && sets !== null })
  })
  return primitives
}

// COLOR_0 = the sum of the groups' colours, each band times its weight. `weights`: per group [r, g, b].
export function mix(primitives, weights) {
  for (const { mesh, sets, mixes } of primitives) {
    if (!mixes) continue
    const { color } = mesh.geometry.attributes
    const mixed = color.array
    for (let v = 0; v < color.count; ++v) mixed[4 * v] = mixed[4 * v + 1] = mixed[4 * v + 2] = 0
    sets.forEach((set, group) => {
      if (!set) return
      const [r, g, b] = weights[group]
      for (let v = 0; v < color.count; ++v) {
        mixed[4 * v] += r * set[3 * v]
        mixed[4 * v + 1] += g * set[3 * v + 1]
        mixed[4 * v + 2] += b * set[3 * v + 2]
      }
    })
    color.needsUpdate = true
  }
}
