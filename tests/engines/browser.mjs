// A page with three.js or Babylon.js in headless Chromium, without a network: every request is answered from files.
import { execFileSync } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'
import { fileURLToPath, pathToFileURL } from 'node:url'

const here = path.dirname(fileURLToPath(import.meta.url))
const packages = path.join(here, '..', 'node_modules')
const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.glb': 'model/gltf-binary',
  '.gltf': 'model/gltf+json', '.png': 'image/png', '.wasm': 'application/wasm' }
const origin = 'http://viewer.test'

function chromium_path() {
  for (const name of ['chromium', 'chromium-browser', 'google-chrome']) {
    try {
      return execFileSync('which', [name], { encoding: 'utf8' }).trim()
    } catch { /* the next one */ }
  }
  throw new Error('no Chromium: apt-get install chromium')
}

// A path of the page's origin -> a file: the packages, the viewer, or any file by its absolute path below /file.
function file_of(url) {
  const { pathname } = new URL(url)
  const name = decodeURIComponent(pathname)
  if (/^\/(three|babylonjs|babylonjs-loaders)\//.test(name)) return path.join(packages, name)
  if (name.startsWith('/file/')) return name.slice('/file'.length)
  return path.join(here, name)
}

export const url_of = (file) => `${origin}/file${path.resolve(file).split('/').map(encodeURIComponent).join('/')}`

async function answer(route) {
  const file = file_of(route.request().url())
  if (!fs.existsSync(file)) return route.fulfill({ status: 404 })
  const contentType = types[path.extname(file)] ?? 'application/octet-stream'
  return route.fulfill({ body: fs.readFileSync(file), contentType })
}

// Drawing is done by SwiftShader, so that no graphics card is needed.
async function launch() {
  const playwright = await import('playwright-core').catch(() => {
    throw new Error('the browser driver is missing: run `npm ci` in the folder tests')
  })
  return playwright.chromium.launch({
    executablePath: chromium_path(),
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  })
}

// What a page complains about, as it does.
function problems_of(page) {
  const problems = []
  page.on('pageerror', (error) => problems.push(`${error}`))
  page.on('console', (message) => { if (message.type() === 'error') problems.push(message.text()) })
  return problems
}

// { page, close }: the viewer is loaded, three.js's or the one named.
export async function open_viewer(name = 'viewer.html') {
  const browser = await launch()
  const page = await browser.newPage()
  const problems = problems_of(page)
  await page.route('**/*', answer)
  await page.goto(`${origin}/${name}`)
  await page.waitForFunction(() => window.viewer !== undefined, null, { timeout: 60_000 }).catch((reason) => {
    throw new Error(`the viewer did not start: ${[...problems, reason].join('\n')}`)
  })
  return { page, close: () => browser.close() }
}

// { open(html), close }: a browser for pages from the disk. `open` answers { page, problems, requests }: what the page complains
// about, and what it asks for beside itself and what it holds.
export async function open_browser(viewport) {
  const browser = await launch()
  const open = async (html) => {
    const page = await browser.newPage({ viewport })
    const [problems, requests] = [problems_of(page), []]
    const address = pathToFileURL(html).href
    page.on('request', (request) => { if (request.url() !== address && !/^(data|blob):/.test(request.url())) requests.push(request.url()) })
    await page.goto(address)
    await page.waitForSelector('html[data-ready], #message.failed', { timeout: 60_000, state: 'attached' }).catch((reason) => {
      throw new Error(`the page did not start: ${[...problems, reason].join('\n')}`)
    })
    return { page, problems, requests }
  }
  return { open, close: () => browser.close() }
}
