// SPDX-License-Identifier: BSD-3-Clause
// The planner, compiled for browsers: one function, a question and an answer.
import { bytesOf, inflate, needsStreams } from "../packed.js";

/** A question's text is no longer, nor is a scene's in a link [bytes]. */
export const MOST_BYTES = 1e6;
const TOO_LONG = "The scene is too large: its text is longer than 1 MB.";
const BROKEN = "The planner broke off and is started anew. Change the scene, or load the page again.";

function answerTo(text, module) {
  const size = module.lengthBytesUTF8(text) + 1;
  if (size > MOST_BYTES) throw new Error(TOO_LONG);
  // On the heap: the module's stack is small, and nothing guards its end.
  const place = module._malloc(size);
  try {
    module.stringToUTF8(text, place, size);
    return JSON.parse(module.ccall("touchdown_ask", "string", ["number"], [place]));
  } finally {
    module._free(place);
  }
}

/** The function that asks a module of `make`. A mistake in a question is an Error with the module's sentence. */
export async function plannerOf(make) {
  let module = await make();
  return (question) => {
    const text = JSON.stringify(question);
    if (!module) throw new Error(BROKEN);
    let answer;
    try {
      answer = answerTo(text, module);
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError || error instanceof RangeError)) throw error;
      // What such a module has in its memory may be anything.
      module = null;
      make().then((made) => (module = made));
      throw new Error(BROKEN);
    }
    if (answer.error !== undefined) throw new Error(answer.error);
    return answer;
  };
}

/** Of the module in this page. */
export async function loadPlanner() {
  needsStreams();
  const packed = document.getElementById("module").textContent;
  const wasmBinary = new Uint8Array(await inflate(bytesOf(packed.trim()), "gzip").arrayBuffer());
  return plannerOf(() => TouchdownPlanner({ wasmBinary }));
}
