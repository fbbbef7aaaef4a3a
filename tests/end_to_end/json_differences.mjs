// Two JSON trees, and every place where they differ.
import fs from 'node:fs'

// The JSON of a .glb or .gltf with integers that JavaScript cannot hold as strings of their digits.
export function exact_json(file) {
  const bytes = fs.readFileSync(file)
  const is_glb = bytes.toString('latin1', 0, 4) === 'glTF'
  const text = is_glb ? bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)) : bytes.toString('utf8')
  return JSON.parse(text.replace(/([[,:]\s*)(-?\d{16,})(?=\s*[,\]}])/g, '$1"#$2"'))
}

const is_tree = (value) => value !== null && typeof value === 'object'
const escaped = (key) => key.replaceAll('~', '~0').replaceAll('/', '~1')

// [{ pointer, before, after }] of all members that were added (before is undefined), removed (after is undefined) or
// changed; a member that is an object or an array is looked into if it is one on both sides.
export function differences(before, after, pointer = '') {
  if (!is_tree(before) || !is_tree(after) || Array.isArray(before) !== Array.isArray(after)) {
    return before === after ? [] : [{ pointer, before, after }]
  }
  const keys = new Set([...Object.keys(before), ...Object.keys(after)])
  return [...keys].flatMap((key) => differences(before[key], after[key], `${pointer}/${escaped(key)}`))
}
