// SPDX-License-Identifier: BSD-3-Clause
// The ESDF-free collision term: every pair is a half-space of one control point, so that neither
// value nor gradient asks the map. X. Zhou et al., "EGO-Planner", RA-L 2020, eq. 4-5.

#include "touchdown/planning/terms/obstacle_pair.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "touchdown/solvers/window_term.h"

namespace touchdown::planning {

namespace {

class HalfSpaces {
 public:
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false;
  static constexpr bool kLinearInBlocks = true;

  HalfSpaces(int control_points, int max_pairs, double clearance)
      : control_points_(control_points), clearance_(clearance) {
    pairs_.reserve(static_cast<std::size_t>(max_pairs));
  }

  int windows() const { return static_cast<int>(pairs_.size()); }
  int first_block(int k) const { return pairs_[k].control_point; }

  template <class T>
  void operator()(int k, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    const ObstaclePair& pair = pairs_[k];
    u[0] = clearance_;
    for (int c = 0; c < 3; ++c) u[0] -= (q[c] - pair.p[c]) * pair.v[c];
  }

  void Jacobian(int k, const double* q, double h, double t, double* u, double* du,
                double* du_dh) const {
    (*this)(k, q, h, t, u);
    for (int c = 0; c < 3; ++c) du[c] = -pairs_[k].v[c];
    du_dh[0] = 0.0;
  }

  void Set(std::span<const ObstaclePair> pairs) {
    if (pairs.size() > pairs_.capacity()) {
      throw std::invalid_argument("obstacle_pair: " + std::to_string(pairs.size()) +
                                  " pairs, there is room for " + std::to_string(pairs_.capacity()));
    }
    for (const ObstaclePair& pair : pairs) {
      if (pair.control_point < 0 || pair.control_point >= control_points_) {
        throw std::invalid_argument("obstacle_pair: control point " +
                                    std::to_string(pair.control_point) + " is not in [0, " +
                                    std::to_string(control_points_ - 1) + "]");
      }
    }
    pairs_.assign(pairs.begin(), pairs.end());
  }

 private:
  int control_points_;
  double clearance_;
  std::vector<ObstaclePair> pairs_;
};

solvers::TermInfo Info() {
  return {"obstacle_pair", "w sum hinge(s_f - (Q - p) . v)", "m", "EGO-Planner eq. 4-5", true};
}

class ObstaclePairTerm : public ObstaclePairs {
 public:
  ObstaclePairTerm(int control_points, int max_pairs, double weight, double clearance)
      : term_(Info(), HalfSpaces(control_points, max_pairs, clearance),
              solvers::HingeLoss(weight, clearance), max_pairs),
        weight_(weight),
        clearance_(clearance) {}

  const solvers::TermInfo& info() const override { return term_.info(); }
  const solvers::TermShape& shape() const override { return term_.shape(); }
  solvers::LossBounds bounds() const override { return term_.bounds(); }
  double nominal_row_weight() const override { return term_.nominal_row_weight(); }
  void Place(solvers::TermBlock* block) const override { term_.Place(block); }
  void Evaluate(const solvers::TermInput& input, const solvers::TermRequest& request,
                solvers::TermBlock* block, const solvers::TermSums& sums) const override {
    term_.Evaluate(input, request, block, sums);
  }
  void SetPairs(std::span<const ObstaclePair> pairs) override { term_.inner().Set(pairs); }
  void SetWeightScale(double scale) override {
    term_.set_loss(solvers::HingeLoss(scale * weight_, clearance_));
  }

 private:
  solvers::WindowTerm<HalfSpaces, solvers::HingeLoss> term_;
  double weight_;
  double clearance_;
};

}  // namespace

std::shared_ptr<ObstaclePairs> MakeObstaclePairs(int control_points, int max_pairs, double weight,
                                                 double clearance) {
  return std::make_shared<ObstaclePairTerm>(control_points, max_pairs, weight, clearance);
}

solvers::TermFactory ObstaclePairFactory() {
  return {Info(), [](int blocks, std::mt19937_64& random) {
            std::normal_distribution<double> normal;
            std::vector<ObstaclePair> pairs;
            for (int i = 0; i < blocks; i += 2) {
              const Eigen::Vector3d v(normal(random), normal(random), normal(random));
              const Eigen::Vector3d p(normal(random), normal(random), normal(random));
              pairs.push_back({i, p, v.normalized()});
            }
            auto term = MakeObstaclePairs(blocks, blocks, 10.0, 0.5);
            term->SetPairs(pairs);
            return term;
          }};
}

}  // namespace touchdown::planning
