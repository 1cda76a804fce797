// Prints the report of Khronos' validator on a file, as JSON.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const [web, path] = process.argv.slice(2);
const validator = createRequire(`${web}/package.json`)("gltf-validator");
const bytes = new Uint8Array(readFileSync(path));
const report = await validator.validateBytes(bytes, { maxIssues: 100 });
console.log(JSON.stringify(report));
