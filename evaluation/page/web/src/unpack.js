// SPDX-License-Identifier: BSD-3-Clause
// From the packed text in the page to a flight's document. What is wrong with it is an Error with one sentence.

const FORMAT = "touchdown flight", VERSION = 1;

function bytesOf(base64) {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).text();
}

export async function unpack(packed) {
  if (typeof DecompressionStream === "undefined") {
    throw new Error("This browser is too old for this page: it needs Chromium 80, Firefox 113 or Safari 16.4.");
  }
  let flight;
  try {
    flight = JSON.parse(await inflate(bytesOf(packed.trim())));
  } catch {
    throw new Error("This page is damaged: its flight cannot be read. Write it again with `touchdown replay`.");
  }
  if (flight.format !== FORMAT || flight.version !== VERSION) {
    throw new Error("This page holds no flight that its own program can show. Write it again with `touchdown replay`.");
  }
  return flight;
}
