// SPDX-License-Identifier: BSD-3-Clause
// The same module as a program: a question a line, an answer a line. What the page's answers are compared with.
#include <iostream>
#include <string>

#include "evaluation/playground/ask.h"

int main() {
  touchdown::evaluation::Playground playground;
  for (std::string question; std::getline(std::cin, question);) {
    std::cout << playground.Ask(question) << std::endl;
  }
}
