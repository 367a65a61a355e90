// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/rendering_check.h"

#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/sim/gl_context.h"

namespace touchdown::evaluation {
namespace {

// Empty: nothing stands against it.
std::optional<std::string> WhyNotRender() {
  try {
    sim::GlContext().MakeCurrent();
    return std::nullopt;
  } catch (const std::runtime_error& error) {
    std::string why = error.what();
    while (!why.empty() && why.back() == '.') why.pop_back();
    return why;
  }
}

}  // namespace

void RequireRendering(const std::string& who) {
  static const std::optional<std::string> why = WhyNotRender();
  if (!why) return;
  throw BadInput(
      fmt::format("{} needs off-screen rendering, which this machine does not offer ({}): mend its "
                  "OSMesa (Debian: libosmesa6); sensing: fast flies without it.",
                  who, *why));
}

}  // namespace touchdown::evaluation
