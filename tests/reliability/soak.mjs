// The figures of docs/reliability.md about single files and batches: node soak.mjs REPORT.json
//
// How long each malformed file takes to be refused; what becomes of every file from elsewhere, in batches of one thread and of all,
// whose bytes must agree; and how much memory each takes under limits that are tighter and tighter. tools/soak sets the
// environment. Ends with 1 if anything was lost, crashed or differed.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import os from 'node:os'
import path from 'node:path'
import { cheapest, from_environment, run, run_for, temporary_folder, test_asset } from '../end_to_end/command_line.mjs'
import { read_gltf, to_glb } from '../end_to_end/gltf_file.mjs'

const assets = from_environment('GLTF_RADIOSITY_ASSETS')
const folder = temporary_folder()
const options = [...cheapest, '--refine', 'none']
const problems = []
const memory_limit = 2048 // MiB

const gltf_files = (place) => fs.readdirSync(place).sort().filter((name) => /\.(glb|gltf)$/.test(name)).map((name) => path.join(place, name))

// Small files that claim to be large, or never to end. Made here: nobody has to store them.
function hostile_files() {
  const place = path.join(folder, 'hostile')
  fs.mkdirSync(place)
  const broken_cube = (name, change) => {
    const { json, buffers } = read_gltf(test_asset('unit_cube.glb'))
    const text = change(json)
    fs.writeFileSync(path.join(place, name), to_glb(text ?? json, Buffer.from(buffers[0])))
  }
  broken_cube('four_billion_vertices.glb', (json) => { for (const accessor of json.accessors) accessor.count = 4294967295 })
  broken_cube('vertices_without_data.glb', (json) => {
    for (const { attributes } of json.meshes[0].primitives) {
      for (const index of Object.values(attributes)) json.accessors[index] = { ...json.accessors[index], count: 4294967295, bufferView: undefined }
    }
  })
  broken_cube('buffer_of_a_terabyte.glb', (json) => { json.buffers[0].byteLength = 2 ** 40 })
  broken_cube('a_million_nodes.glb', (json) => {
    json.nodes = Array.from({ length: 1_000_000 }, () => ({ mesh: 0 }))
    json.scenes[0].nodes = json.nodes.map((_, index) => index)
  })
  broken_cube('nodes_in_a_ring.glb', (json) => { json.nodes = [{ children: [1] }, { children: [0], mesh: 0 }] })
  broken_cube('nested_a_million_deep.glb', (json) => JSON.stringify(json).replace('"asset":{', `"asset":{"extras":${'['.repeat(1e6)}${']'.repeat(1e6)},`))
  broken_cube('vertex_at_1e19.glb', (json) => { json.nodes[0].translation = [1e19, 0, 0] })
  const { json, buffers } = read_gltf(test_asset('draco_box.glb'))
  const noise = Buffer.from(buffers[0])
  noise.fill(0xff, 12)
  fs.writeFileSync(path.join(place, 'draco_noise.glb'), to_glb(json, noise))
  return gltf_files(place)
}

// Each ends by itself, with an exit code that says what happened, and writes only what it promises.
function refusals(files) {
  return files.map((file) => {
    const output = path.join(folder, 'refused.glb')
    fs.rmSync(output, { force: true })
    const { code, signal, lines, seconds } = run(file, output, '--progress', 'none', '--max-memory', `${memory_limit}M`, ...options)
    const well = signal === null && [0, 1, 4].includes(code) && fs.existsSync(output) === (code === 0)
    if (!well) problems.push(`${file}: ${code ?? signal}`)
    return { file: path.basename(file), code, milliseconds: Math.round(1000 * seconds), says: lines.at(-1)?.slice(0, 160) }
  })
}

// Every file from elsewhere, by one thread and by all: exit codes, and whether the bytes agree.
function batches() {
  const outputs = [1, os.cpus().length].map((threads) => {
    const out = path.join(folder, `batch_of_${threads}`)
    fs.mkdirSync(out)
    const { code, signal } = run_for(7200, '--batch', assets, out, '--threads', threads, '--progress', 'none', ...options)
    if (signal !== null || code === 70) problems.push(`batch with ${threads} threads: ${code ?? signal}`)
    return out
  })
  const [one, all] = outputs.map((out) => fs.readdirSync(out, { recursive: true }).filter((name) => /\.(glb|gltf|bin)$/.test(name)).sort())
  const same = one.filter((name) => fs.readFileSync(path.join(outputs[0], name)).equals(fs.readFileSync(path.join(outputs[1], name))))
  if (same.length !== one.length || one.length !== all.length) problems.push('batches differ by their number of threads')
  return { written: one.length, same: same.length }
}

// The highest resident memory of a bake under a limit, refined as by default, MiB; nothing if the limit was too low.
function peak_within(file, limit) {
  const report = path.join(folder, 'report.json')
  const { code, signal } = run(file, path.join(folder, 'limited.glb'), '--force', '--progress', 'none', '--max-memory', `${limit}M`, '--json', report, ...cheapest)
  if (signal !== null || ![0, 1, 4].includes(code)) problems.push(`${file} with ${limit} MiB: ${code ?? signal}`)
  if (code !== 0) return undefined
  const { phases } = JSON.parse(fs.readFileSync(report))
  const peak = Math.round(Math.max(...phases.map((phase) => phase.peakMemoryBytes)) / 2 ** 20)
  if (peak > limit) problems.push(`${file} took ${peak} MiB of ${limit}`)
  return peak
}

// Each file with memory enough, then with less and less than it took.
function memory(files) {
  return files.map((file) => {
    const peak = peak_within(file, memory_limit)
    const tight = peak === undefined ? [] : [0.9, 0.75, 0.6].map((share) => Math.max(64, Math.round(share * peak)))
    return { file: path.basename(file), peak, tight: tight.map((limit) => ({ limit, peak: peak_within(file, limit) })) }
  })
}

const malformed = [...gltf_files(path.join(assets, 'malformed')), ...gltf_files(path.join(assets, 'malformed', 'as_glb'))]
const wild = ['interior', 'objects', 'features'].flatMap((name) => gltf_files(path.join(assets, name)))
assert.ok(malformed.length > 0 && wild.length > 0, `no files in ${assets}`)
const report = { malformed: refusals(malformed), hostile: refusals(hostile_files()), batches: batches(), memory: memory(wild), problems }
fs.writeFileSync(process.argv[2], `${JSON.stringify(report, null, 2)}\n`)
const slowest = Math.max(...[...report.malformed, ...report.hostile].map(({ milliseconds }) => milliseconds))
console.log(`${malformed.length} malformed and ${report.hostile.length} hostile files, the slowest took ${slowest} ms`)
console.log(`${wild.length} files from elsewhere: ${report.batches.written} baked by each batch, ${report.batches.same} the same`)
const tight = report.memory.flatMap((each) => each.tight)
console.log(`${report.memory.filter(({ peak }) => peak).length} baked within ${memory_limit} MiB, the largest took ${Math.max(...report.memory.map(({ peak }) => peak ?? 0))}`)
console.log(`with less than that ${tight.filter(({ peak }) => peak).length} of ${tight.length} baked, at most ${Math.max(...tight.map(({ peak, limit }) => (peak ?? 0) / limit)).toFixed(2)} of the limit was taken; the others were refused`)
for (const problem of problems) console.log(`PROBLEM: ${problem}`)
process.exitCode = problems.length > 0 ? 1 : 0
