// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/interrupt_watch.h"

namespace touchdown::evaluation {
namespace {

volatile std::sig_atomic_t g_signal = 0;

extern "C" void NoteSignal(int signal) { g_signal = signal; }

}  // namespace

InterruptWatch::InterruptWatch() {
  g_signal = 0;
  struct sigaction note = {};
  note.sa_handler = NoteSignal;  // without SA_RESTART: a wait is to end
  sigaction(SIGINT, &note, &interrupt_);
  sigaction(SIGTERM, &note, &terminate_);
}

InterruptWatch::~InterruptWatch() {
  sigaction(SIGINT, &interrupt_, nullptr);
  sigaction(SIGTERM, &terminate_, nullptr);
}

int InterruptWatch::signal() const { return g_signal; }

void InterruptWatch::ThrowIfAsked() const {
  if (signal() != 0) throw Interruption{signal()};
}

}  // namespace touchdown::evaluation
