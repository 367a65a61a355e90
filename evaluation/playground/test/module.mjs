// SPDX-License-Identifier: BSD-3-Clause
// The module, and the program that is made from the same sources, as functions from question to answer.
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { createInterface } from "node:readline";

/** `path`: of the module's script; its .wasm is beside it. */
export async function loadModule(path) {
  const full = resolve(path);
  const make = createRequire(full)(full);
  const module = await make({ wasmBinary: readFileSync(full.replace(/\.js$/, ".wasm")) });
  return (question) => JSON.parse(module.ccall("touchdown_ask", "string", ["string"], [JSON.stringify(question)]));
}

/** `program`: a path. Its answers come as promises; `end` stops it. */
export function startProgram(program) {
  const child = spawn(program, { stdio: ["pipe", "pipe", "inherit"] });
  const waiting = [];
  createInterface({ input: child.stdout }).on("line", (line) => waiting.shift()(JSON.parse(line)));
  const ask = (question) =>
    new Promise((done) => {
      waiting.push(done);
      child.stdin.write(`${JSON.stringify(question)}\n`);
    });
  return { ask, end: () => child.stdin.end() };
}
