// Where the scene is looked at from.
import { Box3, PerspectiveCamera, Quaternion, Vector3 } from 'three'

export function bounds_of(scene) {
  const box = new Box3()
  scene.traverse((object) => { if (object.isMesh) box.expandByObject(object, false) })
  const size = box.isEmpty() ? 1 : Math.max(box.getSize(new Vector3()).length(), 1e-6)
  return { centre: box.isEmpty() ? new Vector3() : box.getCenter(new Vector3()), size }
}

// From outside, a little from the right and from above: what is single-sided opens itself to the view.
function from_outside({ centre, size }) {
  const fov = 40
  const distance = (0.5 * size) / Math.sin((fov / 2) * (Math.PI / 180))
  const eye = new Vector3(0.35, 0.28, 1).setLength(distance).add(centre)
  return { name: 'Overview', eye, at: centre.clone(), fov }
}

// A camera of the file; what it turns about is the point on its axis that is closest to the middle.
function from_file(camera, index, { centre, size }) {
  const eye = camera.getWorldPosition(new Vector3())
  const ahead = new Vector3(0, 0, -1).applyQuaternion(camera.getWorldQuaternion(new Quaternion()))
  const along = Math.max(centre.clone().sub(eye).dot(ahead), 0.05 * size)
  return { name: camera.name || `Camera ${index + 1}`, eye, at: ahead.multiplyScalar(along).add(eye), fov: camera.fov }
}

// [{ name, eye, at, fov }], the first to start with: the file's cameras, then an overview.
export function views_of({ cameras, scene }) {
  const bounds = bounds_of(scene)
  return [...cameras.map((camera, index) => from_file(camera, index, bounds)), from_outside(bounds)]
}

export function create_camera(scene) {
  const { size } = bounds_of(scene)
  return new PerspectiveCamera(40, 1, size / 5000, size * 20)
}
