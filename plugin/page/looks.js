// The ways a primitive can be shown: baked, as lux in false colours, and as it was before the bake.
import { Color, MeshBasicMaterial, MeshLambertMaterial, Vector3 } from 'three'
import { fragment_declarations, light_attribute, lux_of_color, stops } from './illuminance.js'

// What the material has in common with every other look of it: where it is cut out or seen through.
function outline_of(material) {
  const { map, side, alphaTest, transparent, opacity, depthWrite, name } = material
  return { map, side, alphaTest, transparent, opacity, depthWrite, name, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }
}

// As COLOR_0 says. What stayed lit (--target keep) is shown as its shader would: base colour times light.
function baked_look(material) {
  const basic = new MeshBasicMaterial({ ...outline_of(material), vertexColors: true, color: material.color })
  basic.toneMapped = false
  return basic
}

// Under a headlight: the base colour that is in COLOR_0, taken out again.
function unbaked_look({ mesh, reflectance }) {
  const { material, geometry } = mesh
  const lit = !material.isMeshBasicMaterial
  const color = lit || !reflectance ? material.color : new Color().fromArray(reflectance)
  const look = new MeshLambertMaterial({ ...outline_of(material), color, flatShading: !geometry.attributes.normal })
  look.toneMapped = false
  return look
}

// False colours, grey where the lux are not known; textures only cut out.
function lux_look(primitive, signature, scale) {
  const of_color = lux_of_color(primitive, signature)
  const attribute = light_attribute(primitive, signature)
  const look = new MeshBasicMaterial({ ...outline_of(primitive.mesh.material), vertexColors: true })
  look.toneMapped = false
  // One program serves all materials of a kind, and each brings its own uniforms.
  const uniforms = {
    luxOfColor: { value: new Vector3().fromArray(of_color ?? [0, 0, 0]) },
    luxStops: { value: stops.map((stop) => new Vector3(...stop.map((code) => code / 255))) },
    ...scale,
  }
  look.userData.lux_of_color = uniforms.luxOfColor.value
  look.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms)
    if (attribute !== 'color') {
      shader.vertexShader = `attribute vec3 ${attribute};\n${shader.vertexShader}`
        .replace('#include <color_vertex>', `#include <color_vertex>\nvColor.rgb = ${attribute};`)
    }
    const shown = of_color ? 'falseColor(dot(vColor.rgb, luxOfColor))' : 'sRGBTransferEOTF(vec4(vec3(0.36), 1.0)).rgb'
    shader.fragmentShader = shader.fragmentShader
      .replace('void main() {', `${fragment_declarations}\nvoid main() {`)
      .replace('#include <color_fragment>', `#include <color_fragment>\ndiffuseColor.rgb = ${shown};`)
  }
  look.customProgramCacheKey = () => `${of_color !== null} ${attribute}`
  return look
}

// { baked, lux, unbaked }: a material for each way of showing the primitive, made from its own. `scale`: the uniforms
// { luxEnd, luxLogarithmic } that all of them share.
export const looks_of = (primitive, signature, scale) => ({
  baked: baked_look(primitive.mesh.material),
  lux: lux_look(primitive, signature, scale),
  unbaked: unbaked_look(primitive),
})
