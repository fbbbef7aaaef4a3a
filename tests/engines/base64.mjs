// Bytes on their way from a page: as a list of numbers a picture takes seconds.

// In the page.
export function as_base64(bytes) {
  let text = ''
  for (let first = 0; first < bytes.length; first += 0x8000) text += String.fromCharCode(...bytes.subarray(first, first + 0x8000))
  return btoa(text)
}

// In the test: a plain array.
export const from_base64 = (text) => [...Buffer.from(text, 'base64')]
