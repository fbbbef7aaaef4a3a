// What an engine that follows the specification shows of a baked file: COLOR_0 x base colour texture, unlit.
import zlib from 'node:zlib'
import { image_bytes } from '../end_to_end/gltf_file.mjs'
import { camera_rays, hits_along, interpolate, world_triangles } from './geometry.mjs'

const to_linear = (code) => (code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4)
const to_srgb = (linear) => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055)
const clamp = (value) => Math.min(Math.max(value, 0), 1)

// The PNGs of test_assets: 8 bits per channel, no filter, one IDAT.
function decode_png(bytes) {
  const [width, height] = [bytes.readUInt32BE(16), bytes.readUInt32BE(20)]
  const channels = { 2: 3, 6: 4 }[bytes[25]]
  const at = bytes.indexOf('IDAT')
  const rows = zlib.inflateSync(bytes.subarray(at + 4, at + 4 + bytes.readUInt32BE(at - 4)))
  const texel = (x, y) => {
    const start = y * (1 + channels * width) + 1 + channels * x
    const [r, g, b, a = 255] = rows.subarray(start, start + channels)
    return [...[r, g, b].map((code) => to_linear(code / 255)), a / 255]
  }
  return { width, height, texel }
}

const wraps = {
  10497: (i, size) => ((i % size) + size) % size,
  33648: (i, size) => { const k = ((i % (2 * size)) + 2 * size) % (2 * size); return k < size ? k : 2 * size - 1 - k },
  33071: (i, size) => Math.min(Math.max(i, 0), size - 1),
}

// KHR_texture_transform: scale, then rotate, then move.
function transform_uv([u, v], { offset = [0, 0], rotation = 0, scale = [1, 1] } = {}) {
  const [s, c] = [Math.sin(rotation), Math.cos(rotation)]
  const [x, y] = [u * scale[0], v * scale[1]]
  return [c * x + s * y + offset[0], -s * x + c * y + offset[1]]
}

// uv -> linear RGBA, bilinear.
function sampler_of(gltf, info) {
  const texture = gltf.json.textures[info.index]
  const { width, height, texel } = decode_png(image_bytes(gltf, texture.source))
  const { wrapS = 10497, wrapT = 10497 } = gltf.json.samplers?.[texture.sampler] ?? {}
  return (uv) => {
    const [u, v] = transform_uv(uv, info.extensions?.KHR_texture_transform)
    const [x, y] = [u * width - 0.5, v * height - 0.5]
    const [left, top] = [Math.floor(x), Math.floor(y)]
    const sum = [0, 0, 0, 0]
    for (const [i, j] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
      const weight = Math.abs(1 - i - (x - left)) * Math.abs(1 - j - (y - top))
      const color = texel(wraps[wrapS](left + i, width), wraps[wrapT](top + j, height))
      color.forEach((band, k) => { sum[k] += weight * band })
    }
    return sum
  }
}

// (x, y) in pixels -> [r, g, b] as sRGB codes in [0, 255], not rounded, of the view of the file's first camera.
export function expected_colors(gltf, width, height) {
  const triangles = world_triangles(gltf)
  const ray_through = camera_rays(gltf, width, height)
  const samplers = gltf.json.materials.map(({ pbrMetallicRoughness: { baseColorTexture } = {} }) =>
    baseColorTexture && sampler_of(gltf, baseColorTexture))

  const shade = (hit) => {
    const { material, attributes } = hit.triangle.primitive
    const color = attributes.COLOR_0 === undefined ? [1, 1, 1, 1] : interpolate(hit, 'COLOR_0')
    const texel = samplers[material]?.(interpolate(hit, 'TEXCOORD_0')) ?? [1, 1, 1, 1]
    const { baseColorFactor = [1, 1, 1, 1] } = gltf.json.materials[material].pbrMetallicRoughness
    return color.map((band, k) => band * texel[k] * baseColorFactor[k])
  }

  return (x, y) => {
    // From the front to the back until something is opaque. Engines blend what is encoded, as framebuffers hold it.
    const sum = [0, 0, 0]
    let visible = 1
    for (const hit of hits_along(ray_through(x, y), triangles)) {
      const material = gltf.json.materials[hit.triangle.primitive.material]
      const { alphaMode = 'OPAQUE', alphaCutoff = 0.5, doubleSided } = material
      if (!hit.front && !doubleSided) continue
      const [r, g, b, alpha] = shade(hit)
      if (alphaMode === 'MASK' && alpha < alphaCutoff) continue
      const opacity = alphaMode === 'BLEND' ? clamp(alpha) : 1
      ;[r, g, b].forEach((band, k) => { sum[k] += visible * opacity * 255 * to_srgb(clamp(band)) })
      visible *= 1 - opacity
      if (visible === 0) break
    }
    return sum
  }
}
