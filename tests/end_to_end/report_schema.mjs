// What docs/report.schema.json says of a report.
import Ajv2020 from 'ajv/dist/2020.js'
import fs from 'node:fs'

const schema = JSON.parse(fs.readFileSync(new URL('../../docs/report.schema.json', import.meta.url), 'utf8'))
const ajv = new Ajv2020({ strict: true, allErrors: true, allowUnionTypes: true })
ajv.addSchema(schema, 'report')
const any_kind = ajv.getSchema('report')

// What is wrong with a report of a kind ("bake", "failure", "verify", "relight", "batch"), one line each; of any kind without one.
export function wrong_with_report(report, kind) {
  const validate = kind ? ajv.getSchema(`report#/$defs/${kind}`) : any_kind
  if (validate(report)) return []
  return validate.errors.map(({ instancePath, message, params }) => `${instancePath} ${message} ${JSON.stringify(params)}`)
}

// The report that `text` holds; throws if it is not as the schema has it.
export function valid_report(text, kind = 'bake') {
  const report = JSON.parse(text)
  const wrong = wrong_with_report(report, kind)
  if (wrong.length > 0) throw new Error(`not as docs/report.schema.json has it:\n${wrong.join('\n')}`)
  return report
}
