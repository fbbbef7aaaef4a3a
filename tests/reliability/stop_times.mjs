// How long a bake goes on after SIGTERM, phase by phase: `node stop_times.mjs IN.glb [options of the bake]`.
//
// The bake is started once for each phase and gets the signal as soon as the phase is announced. Prints a table, and ends
// with 1 if any took longer than a second.
import { spawn } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import { program, temporary_folder } from '../end_to_end/command_line.mjs'

const phases = ['read', 'import', 'subdivide', 'patches', 'direct', 'sky', 'solve', 'gather', 'fit', 'refine', 'simplify',
  'export', 'compress', 'write']
const promised = 1000

// Milliseconds from the signal to the end, and how it ended; nothing if the phase never came.
function stop_in(phase, input, options) {
  const folder = temporary_folder()
  const output = path.join(folder, 'out.glb')
  fs.writeFileSync(output, 'old')
  const child = spawn(program(), [input, output, '--progress', 'plain', ...options], { stdio: ['ignore', 'ignore', 'pipe'] })
  let sent
  let text = ''
  child.stderr.on('data', (data) => {
    text += data
    if (sent !== undefined || !new RegExp(`\\b${phase}\\b`).test(text)) return
    sent = process.hrtime.bigint()
    child.kill('SIGTERM')
  })
  return new Promise((resolve) => {
    child.on('exit', (code, signal) => {
      const milliseconds = sent === undefined ? undefined : Number(process.hrtime.bigint() - sent) / 1e6
      const left = fs.readdirSync(folder)
      const is_whole = left.length === 1 && (code === 0 || fs.readFileSync(output, 'utf8') === 'old')
      resolve({ milliseconds, ending: code ?? signal, is_whole })
    })
  })
}

const [input, ...options] = process.argv.slice(2)
let late = false
for (const phase of phases) {
  const { milliseconds, ending, is_whole } = await stop_in(phase, input, options)
  if (milliseconds === undefined) continue
  late ||= milliseconds > promised || !is_whole
  console.log(`${phase.padEnd(10)} ${milliseconds.toFixed(0).padStart(5)} ms  exit ${ending}${is_whole ? '' : '  NOT WHOLE'}`)
}
process.exitCode = late ? 1 : 0
