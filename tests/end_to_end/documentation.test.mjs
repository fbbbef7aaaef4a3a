// docs/gltf-support.md names a test for each feature: these tests exist.
import assert from 'node:assert/strict'
import fs from 'node:fs'
import path from 'node:path'
import test from 'node:test'

const root = path.join(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..')
const read = (file) => fs.readFileSync(path.join(root, file), 'utf8')
const sources = ['tests/plugin', 'tests/core'].flatMap((folder) => fs.readdirSync(path.join(root, folder), { recursive: true })
  .filter((name) => name.endsWith('_test.cpp')).map((name) => read(path.join(folder, name)))).join('\n')
const rows = read('docs/gltf-support.md').split('\n').filter((line) => /^\| (?!feature|---)/.test(line))

// The names of tests in the last column of a row.
const named = (row) => [...row.split('|').at(-2).matchAll(/`([^`]+)`/g)].map(([, name]) => name)

// `Suite.Name` in C++, or `end_to_end/file: sentence`, whose sentence may have parts that are filled in.
function exists(name) {
  const [, file, sentence] = /^end_to_end\/(\w+): (.*)$/.exec(name) ?? []
  if (file === undefined) return new RegExp(`TEST(_F|_P)?\\(${name.replace('.', ',\\s*')}\\)`).test(sources)
  const titles = [...read(`tests/end_to_end/${file}.test.mjs`).matchAll(/test\((['`])(.*?)\1/g)].map(([, , title]) => title)
  const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&')
  return titles.some((title) => new RegExp(`^${title.split(/\$\{[^}]*\}/).map(escaped).join('.*')}$`).test(sentence))
}

test('every row of docs/gltf-support.md names tests that exist', () => {
  assert.ok(rows.length > 40, `${rows.length} rows`)
  for (const row of rows) {
    assert.ok(named(row).length > 0, `no test shows ${row}`)
    for (const name of named(row)) assert.ok(exists(name), `there is no test ${name}`)
  }
})

test('a test that is not there is seen', () => {
  for (const name of ['Instancing.NoSuchTest', 'end_to_end/refusals: no such sentence']) assert.ok(!exists(name), name)
})
