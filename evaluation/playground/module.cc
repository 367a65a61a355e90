// SPDX-License-Identifier: BSD-3-Clause
// The module that the page calls, where it is compiled for a browser.
#include <string>

#include <emscripten/emscripten.h>

#include "evaluation/playground/ask.h"

/// The answer to a question; it is there until the next.
extern "C" EMSCRIPTEN_KEEPALIVE const char* touchdown_ask(const char* question) {
  static touchdown::evaluation::Playground playground;
  static std::string answer;
  answer = playground.Ask(question);
  return answer.c_str();
}
