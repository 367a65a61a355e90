// SPDX-License-Identifier: BSD-3-Clause
// The planner, compiled for browsers: one function, a question and an answer.
import { bytesOf, inflate, needsStreams } from "../packed.js";

/** The function that asks. A mistake in a question is an Error with the module's sentence. */
export async function loadPlanner() {
  needsStreams();
  const packed = document.getElementById("module").textContent;
  const wasmBinary = new Uint8Array(await inflate(bytesOf(packed.trim()), "gzip").arrayBuffer());
  const module = await TouchdownPlanner({ wasmBinary });
  return (question) => {
    const answer = JSON.parse(module.ccall("touchdown_ask", "string", ["string"], [JSON.stringify(question)]));
    if (answer.error !== undefined) throw new Error(answer.error);
    return answer;
  };
}
