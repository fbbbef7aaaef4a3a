// The Khronos validator: what it says of an output that it does not say of the input.
import fs from 'node:fs'
import path from 'node:path'

const validator = (await import('gltf-validator').catch(() => {
  throw new Error('the Khronos validator is missing: run `npm ci` in the folder tests')
})).default

const severity_error = 0

// Errors of a file, as { code, message, pointer }.
export async function errors_of(file) {
  const folder = path.dirname(file)
  const bytes_of = (path_of_file) => new Uint8Array(fs.readFileSync(path_of_file))
  const unreadable = (reason) => [{ severity: severity_error, code: 'UNREADABLE', message: `${reason}` }]
  const messages = await validator.validateBytes(bytes_of(file), {
    uri: path.basename(file),
    maxIssues: 0,
    externalResourceFunction: async (uri) => bytes_of(path.join(folder, decodeURIComponent(uri))),
  }).then(({ issues }) => issues.messages, unreadable)
  return messages.filter(({ severity }) => severity === severity_error)
}

// Pointers move when objects are added; a kind of error that the input has as well is not ours. COLOR_0 is
// ours in any case.
export async function new_errors(input, output) {
  const known = new Set((await errors_of(input)).map(({ code }) => code))
  const is_ours = ({ code, pointer }) => !known.has(code) || /COLOR_0/.test(pointer ?? '')
  return (await errors_of(output)).filter(is_ours).map(({ code, message, pointer }) => `${code} ${pointer}: ${message}`)
}
