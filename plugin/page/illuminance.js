// Colours -> lux, and lux -> false colours.
//
// COLOR_0 x base colour factor = k x reflectance x H / pi, so H = pi x COLOR_0 x factor / (k x reflectance) in each band;
// illuminance is its luminance-weighted sum. k is asset.extras.radiosity.exposure, the reflectance
// extras.radiosity.reflectance of the primitive, which is there where it is the same at every vertex. What emits light itself
// (extras.radiosity.emits) shows more than it reflects: its lux are not known. A band that is hardly reflected says nothing about the light: the others stand in for it.

const luminance_weights = [0.2126, 0.7152, 0.0722]
const darkest = 0.004

// Evenly spaced, sRGB: from dark blue to white-hot. The legend and the shader interpolate them alike.
export const stops = [
  [20, 20, 60], [36, 66, 168], [26, 140, 190], [46, 178, 110], [190, 200, 50], [244, 160, 40], [226, 70, 40], [255, 225, 205],
]

// The lux of each band of COLOR_0, so that lux = the sum over bands; null where it is not known.
export function lux_of_color({ factor, reflectance, emits }, signature) {
  if (!reflectance || emits || !(signature.exposure > 0)) return null
  const weights = luminance_weights.map((weight, band) => (reflectance[band] >= darkest ? weight : 0))
  const sum = weights.reduce((a, b) => a + b, 0)
  if (sum === 0) return null
  return weights.map((weight, band) => (weight === 0 ? 0
    : (weight / sum) * Math.PI * factor.toArray()[band] / (signature.exposure * reflectance[band])))
}

// The attribute of three.js with the light as it was before COLOR_0 was cut off at white, where the file has it; else COLOR_0.
export function light_attribute({ mesh, sets }, signature) {
  const unclamped = signature.radiance?.toLowerCase()
  return !sets && unclamped in mesh.geometry.attributes ? unclamped : 'color'
}

export const weighed = (weights, color, v) => weights[0] * color.getX(v) + weights[1] * color.getY(v) + weights[2] * color.getZ(v)

// A number that reads well, not below `value`.
function round_up(value) {
  const power = 10 ** Math.floor(Math.log10(value))
  return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((step) => step * power >= value * 0.999999) * power
}

// Lux that nearly nowhere is exceeded: 98 % of some thousand vertices.
export function usual_end(primitives, signature) {
  const found = []
  for (const primitive of primitives) {
    const weights = lux_of_color(primitive, signature)
    if (!weights) continue
    const color = primitive.mesh.geometry.attributes[light_attribute(primitive, signature)]
    const step = Math.max(1, Math.floor(color.count / 2000))
    for (let v = 0; v < color.count; v += step) found.push(weighed(weights, color, v))
  }
  found.sort((a, b) => a - b)
  const end = found[Math.floor(0.98 * (found.length - 1))]
  return end > 0 ? round_up(end) : 1
}

const decades = 3  // that a logarithmic scale shows

// What lies at a place of the scale, in [0, 1].
export const lux_at = (place, { end, logarithmic }) => (logarithmic ? end * 10 ** (decades * (place - 1)) : end * place)

export const fragment_declarations = `
uniform vec3 luxOfColor;
uniform float luxEnd;
uniform bool luxLogarithmic;
uniform vec3 luxStops[${stops.length}];
vec3 falseColor(const in float lux) {
  float place = luxLogarithmic ? 1.0 + log(max(lux, 1e-30) / luxEnd) / ${(decades * Math.LN10).toFixed(6)} : lux / luxEnd;
  float at = clamp(place, 0.0, 1.0) * ${(stops.length - 1).toFixed(1)};
  int below = min(int(at), ${stops.length - 2});
  return sRGBTransferEOTF(vec4(mix(luxStops[below], luxStops[below + 1], at - float(below)), 1.0)).rgb;
}
`
