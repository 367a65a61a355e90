// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/campaign_progress.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchdown::evaluation {

std::string CampaignLine(const CampaignState& state, double elapsed_s) {
  std::string line = fmt::format("{} of {} trials, {} succeeded and {} failed", state.flown,
                                 state.all, state.succeeded, state.flown - state.succeeded);
  const int flown = state.flown - state.resumed;
  if (flown > 0) {
    line += fmt::format(", {:.2f} a second, {:.0f} s left", flown / elapsed_s,
                        elapsed_s / flown * (state.all - state.flown));
  }
  return line;
}

void CampaignProgress::operator()(const CampaignState& state) {
  if (!tell_) {
    tell_.emplace();
    if (state.resumed == 0) return;
    if (state.resumed == state.all) {
      spdlog::info("all {} trials were flown before", state.all);
    } else {
      spdlog::info("{} of {} trials were flown before: going on with the others", state.resumed,
                   state.all);
    }
    return;
  }
  (*tell_)(CampaignLine(state, tell_->elapsed_s()), state.flown == state.all);
}

int Interrupted(const CampaignResult& result, const std::string& db) {
  const CampaignState& state = result.state;
  spdlog::warn("interrupted after {} of {} trials: {}", state.flown, state.all,
               db.empty()
                   ? "nothing is kept without --db"
                   : fmt::format("they are in {}, and the same command goes on from there", db));
  return 128 + result.interrupted_by;
}

}  // namespace touchdown::evaluation
