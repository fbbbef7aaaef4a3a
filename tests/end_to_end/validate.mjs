// node validate.mjs IN OUT: prints the errors of OUT that IN did not have; exits with 1 if there are any.
import { new_errors } from './validator.mjs'

const [input, output] = process.argv.slice(2)
const errors = await new_errors(input, output)
for (const error of errors) console.log(error)
process.exitCode = errors.length > 0 ? 1 : 0
