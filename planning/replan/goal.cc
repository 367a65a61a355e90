// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/replan/goal.h"

#include <stdexcept>

namespace touchdown::planning {

GoalAt::GoalAt(const Eigen::Vector3d& p_W) : p_W_(p_W) {
  if (!p_W.allFinite()) throw std::invalid_argument("GoalAt: the point is not finite");
}

estimation::PadState GoalAt::At(double /*t*/) const noexcept {
  estimation::PadState state;
  state.p_WP = p_W_;
  return state;
}

MovingGoal::MovingGoal(std::function<Position(const Taylor&)> position)
    : position_(std::move(position)) {
  if (!position_) throw std::invalid_argument("MovingGoal: there is no function");
}

estimation::PadState MovingGoal::At(double t) const noexcept {
  estimation::PadState state;
  try {
    const Position p = position_(Taylor::Time(t));
    for (int i = 0; i < 3; ++i) {
      state.p_WP[i] = p[i].value();
      state.v_WP[i] = p[i].first();
      state.a_WP[i] = p[i].second();
      state.j_WP[i] = p[i].third();
    }
  } catch (...) {
    return estimation::UnknownPad().At(t);
  }
  const bool finite = state.p_WP.allFinite() && state.v_WP.allFinite() && state.a_WP.allFinite() &&
                      state.j_WP.allFinite();
  return finite ? state : estimation::UnknownPad().At(t);
}

}  // namespace touchdown::planning
