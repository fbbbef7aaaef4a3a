// World-space triangles of a glTF and rays through a camera's pixels: what a renderer must see, found without one.
import { nodes_of_scene, primitives_of_scene, read_accessor, triangles_of } from '../end_to_end/gltf_file.mjs'

// 4x4 matrices are column-major, [16].
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]

function multiply(a, b) {
  return identity.map((_, i) => {
    const [column, row] = [i >> 2, i & 3]
    return [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + row] * b[4 * column + k], 0)
  })
}

function local_matrix({ matrix, translation = [0, 0, 0], rotation = [0, 0, 0, 1], scale = [1, 1, 1] }) {
  if (matrix) return matrix
  const [x, y, z, w] = rotation
  const [sx, sy, sz] = scale
  return [
    (1 - 2 * (y * y + z * z)) * sx, 2 * (x * y + z * w) * sx, 2 * (x * z - y * w) * sx, 0,
    2 * (x * y - z * w) * sy, (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z + x * w) * sy, 0,
    2 * (x * z + y * w) * sz, 2 * (y * z - x * w) * sz, (1 - 2 * (x * x + y * y)) * sz, 0,
    ...translation, 1,
  ]
}

const transform_point = (m, [x, y, z]) => [0, 1, 2].map((k) => m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k])
const subtract = (a, b) => a.map((x, k) => x - b[k])
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

function world_matrices({ json }, nodes) {
  const world = {}
  for (const node of nodes) world[node] ??= local_matrix(json.nodes[node])
  for (const node of nodes) {
    const { children = [] } = json.nodes[node]
    for (const child of children) world[child] = multiply(world[node], local_matrix(json.nodes[child]))
  }
  return world
}

const determinant = (m) => dot(m.slice(0, 3), cross(m.slice(4, 7), m.slice(8, 11)))

// [{ corners (world), attributes (name -> three rows), primitive }] of the default scene, counter-clockwise in front.
export function world_triangles(gltf) {
  const world = world_matrices(gltf, nodes_of_scene(gltf))
  return primitives_of_scene(gltf).flatMap(([node, primitive]) => {
    if ((primitive.mode ?? 4) < 4) return []
    const rows = Object.entries(primitive.attributes).map(([name, index]) => [name, read_accessor(gltf, index)])
    const points = rows.find(([name]) => name === 'POSITION')[1].map((point) => transform_point(world[node], point))
    return triangles_of(gltf, primitive).map(([a, b, c]) => {
      const vertices = determinant(world[node]) < 0 ? [a, c, b] : [a, b, c]
      const attributes = Object.fromEntries(rows.map(([name, values]) => [name, vertices.map((k) => values[k])]))
      return { corners: vertices.map((k) => points[k]), attributes, primitive }
    })
  })
}

// (pixel x, pixel y) -> { origin, direction } for the file's first camera; y counts from the top.
export function camera_rays(gltf, width, height) {
  const nodes = nodes_of_scene(gltf)
  const node = nodes.find((index) => gltf.json.nodes[index].camera !== undefined)
  const matrix = world_matrices(gltf, nodes)[node]
  const half = Math.tan(gltf.json.cameras[gltf.json.nodes[node].camera].perspective.yfov / 2)
  return (x, y) => {
    const inside = [(((2 * x) / width - 1) * half * width) / height, (1 - (2 * y) / height) * half, -1]
    return { origin: matrix.slice(12, 15), direction: subtract(transform_point(matrix, inside), matrix.slice(12, 15)) }
  }
}

// Moeller and Trumbore. Fast, Minimum Storage Ray-Triangle Intersection. 1997
function intersect({ origin, direction }, [a, b, c]) {
  const [e1, e2] = [subtract(b, a), subtract(c, a)]
  const p = cross(direction, e2)
  const facing = dot(e1, p)
  if (facing === 0) return null
  const from_a = subtract(origin, a)
  const u = dot(from_a, p) / facing
  if (u < 0 || u > 1) return null
  const q = cross(from_a, e1)
  const v = dot(direction, q) / facing
  const distance = dot(e2, q) / facing
  return v >= 0 && u + v <= 1 && distance > 0 ? { distance, weights: [1 - u - v, u, v], front: facing > 0 } : null
}

// Every triangle a ray meets, nearest first: [{ distance, weights (of the corners), front, triangle }].
export function hits_along(ray, triangles) {
  const hits = []
  for (const triangle of triangles) {
    const hit = intersect(ray, triangle.corners)
    if (hit) hits.push({ ...hit, triangle })
  }
  return hits.sort((a, b) => a.distance - b.distance)
}

// An attribute at a hit: the corners' values weighed.
export function interpolate({ weights, triangle }, name) {
  const rows = triangle.attributes[name]
  return rows[0].map((_, k) => weights[0] * rows[0][k] + weights[1] * rows[1][k] + weights[2] * rows[2][k])
}
