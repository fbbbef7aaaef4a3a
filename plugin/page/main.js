// START HERE, the page: unpack the scene that the page carries -> draw it -> let people change its light.
import { create_picture } from './picture.js'
import { create_panel } from './panel.js'
import { packed_model, unpack } from './unpack.js'

const message = document.getElementById('message')

// What went wrong, where everybody sees it.
function fail(error) {
  console.error(error)
  message.classList.add('failed')
  message.hidden = false
  message.textContent = `This scene cannot be shown.\n${error.message ?? error}`
}

async function start() {
  const model = await unpack(packed_model())
  const picture = create_picture(document.getElementById('picture'), model)
  create_panel(model, picture)
  message.hidden = true
  document.documentElement.dataset.ready = 'true'
}

start().catch(fail)
