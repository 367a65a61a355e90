// SPDX-License-Identifier: BSD-3-Clause
// From the packed text in the page to a flight's document. What is wrong with it is an Error with one sentence.

import { bytesOf, inflate, needsStreams } from "./packed.js";

const FORMAT = "touchdown flight", VERSION = 1;

export async function unpack(packed) {
  needsStreams();
  let flight;
  try {
    flight = JSON.parse(await inflate(bytesOf(packed.trim()), "deflate").text());
  } catch {
    throw new Error("This page is damaged: its flight cannot be read. Write it again with `touchdown replay`.");
  }
  if (flight.format !== FORMAT || flight.version !== VERSION) {
    throw new Error("This page holds no flight that its own program can show. Write it again with `touchdown replay`.");
  }
  return flight;
}
