// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/rendering_check.h"

#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/words.h"
#include "evaluation/base/worker_process.h"
#include "sim/rendering/gl_context.h"

namespace touchdown::evaluation {
namespace {

constexpr char kWorks[] = "works";

std::string Try() {
  try {
    sim::GlContext().MakeCurrent();
    return kWorks;
  } catch (const std::runtime_error& error) {
    return WithoutStop(error.what());
  }
}

// Empty if rendering works. It is tried in a separate process, because the rasteriser starts threads that stay. A
// process with threads must not be forked, and a sweep forks for its trials.
std::optional<std::string> WhyNotRender() {
  constexpr double kTimeout = 60.0;  // [s]
  WorkerProcess process([](int) { return Try(); }, kTimeout);
  process.Start(0);
  const WorkerReply reply = process.Receive();
  if (reply.end == WorkerReply::End::kTimedOut) return "it does not come to an end";
  if (reply.end == WorkerReply::End::kDied) return "it ends by " + reply.text;
  if (reply.text == kWorks) return std::nullopt;
  return reply.text;
}

}  // namespace

void RequireRendering(const std::string& who, const std::string& way_out) {
  static const std::optional<std::string> why = WhyNotRender();
  if (!why) return;
  throw BadInput(
      fmt::format("{} needs off-screen rendering, which this machine does not offer ({}): "
                  "install OSMesa (Debian: libosmesa6){}{}.",
                  who, *why, way_out.empty() ? "" : "; ", way_out));
}

void RequireRenderedSensing() {
  RequireRendering("sensing: rendered", "sensing: fast flies without it");
}

}  // namespace touchdown::evaluation
