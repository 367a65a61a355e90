// SPDX-License-Identifier: BSD-3-Clause
// Bytes as text, and smaller.

export function needsStreams() {
  if (typeof DecompressionStream === "undefined") {
    throw new Error("This browser is too old for this page: it needs Chromium 80, Firefox 113 or Safari 16.4.");
  }
}

export function bytesOf(base64) {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** As a Response, whose text or bytes can be waited for. `format`: "deflate" or "gzip". */
export function inflate(bytes, format) {
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format)));
}

export async function deflate(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
