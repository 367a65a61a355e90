// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/problem/batch_term.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "solvers/problem/run_time_term.h"

namespace touchdown::solvers {

namespace {

// Steps and weights of a first difference of fourth order. One of second order is only good to
// 1e-10: a check of curvatures by differences of such slopes would see only noise.
constexpr std::array<double, 4> kSteps = {-2.0, -1.0, 1.0, 2.0};
constexpr std::array<double, 4> kWeights = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};

// Of u whose fifth derivative is some hundred times u over scale^5.
constexpr double kSlopeError = 1e-11;

// Steps where truncation and rounding are of one size: of the above, of a first difference of
// slopes, of a second difference.
const double kFineStep = std::pow(std::numeric_limits<double>::epsilon(), 0.2);
const double kFirstStep = std::cbrt(std::numeric_limits<double>::epsilon());
const double kSecondStep = std::pow(std::numeric_limits<double>::epsilon(), 0.25);

// One-sided, over 0, 1, ... 4 steps: of fourth order, too.
constexpr std::array<double, 5> kSideWeights = {-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25};

// A smaller step would be rounded in x.
constexpr double kRounding = 1e4 * std::numeric_limits<double>::epsilon();

// A number and its bounds, which are none where it is beyond them.
struct Bounded {
  Bounded(double at, double lo, double hi)
      : x(at), lower(at < lo || at > hi ? -kNone : lo), upper(at < lo || at > hi ? kNone : hi) {}
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double x, lower, upper;

  // Four of them have room to one side at least. 0: it is fixed.
  double Step(double wanted) const {
    const double least = kRounding * std::abs(x), most = 0.125 * (upper - lower);
    return most > least ? std::min(std::max(wanted, least), most) : 0.0;
  }
  bool HasRoom(double from, double to) const { return x + from >= lower && x + to <= upper; }
  double Clamped(double to) const { return std::clamp(to, lower, upper); }  // rounding
  // The nearest middle of one step to either side.
  double Middle(double step) const {
    return step > 0.0 ? std::clamp(x, lower + step, upper - step) : x;
  }
};

// Numbers of the copies that a call asks for at a time.
constexpr std::size_t kMostNumbers = std::size_t{1} << 22;

}  // namespace

/// The term's windows at one point, moved about as a list of copies asks.
class BatchTerm::Differences {
 public:
  Differences(const BatchTerm& term, const TermInput& input, const TermBlock& block)
      : term_(term),
        input_(input),
        t0_(input.t0),
        h_(input.h),
        free_(term.UsesInterval(input)),
        n_(block.windows),
        v_(term.shape_.variables()),
        m_(term.shape_.outputs),
        end_(block.windows) {
    const int d = term.shape_.block_size;
    for (int k = 0; k < n_; ++k) {
      first_block_.push_back(block.first_block[k]);
      const double* q = input.x + block.first_block[k] * d;
      q_.insert(q_.end(), q, q + v_);
    }
  }

  void Values(TermBlock* block) {
    const std::vector<double> u = ValuesAt(h_);
    std::copy_n(u.begin(), n_ * m_, block->u.begin());
  }

  /// u, du and du_dh of the block.
  void Slopes(TermBlock* block) {
    const OwnSlopes own = term_.map_->own_slopes();
    if (own == OwnSlopes::kNone) {
      CallForSlopes(block);
    } else {
      Start(h_);
      Add([](int, double*) {});
      term_.map_->Jacobian(Batch(), block->u.data(), block->du.data(), block->du_dh.data());
    }
    if (own == OwnSlopes::kAll) return;
    std::fill_n(block->du_dh.begin(), n_ * m_, 0.0);
    const double step = Interval().Step(h_ * kFineStep);
    if (!free_ || step == 0.0) return;
    const auto add = [&](double steps, double weight) {
      const std::vector<double> u = ValuesAt(Interval().Clamped(h_ + steps * step));
      for (int i = 0; i < n_ * m_; ++i) block->du_dh[i] += weight * u[i] / step;
    };
    if (Interval().HasRoom(-2.0 * step, 2.0 * step)) {
      for (std::size_t s = 0; s < kSteps.size(); ++s) add(kSteps[s], kWeights[s]);
      return;
    }
    const double side = Interval().HasRoom(0.0, 4.0 * step) ? 1.0 : -1.0;
    for (std::size_t s = 0; s < kSideWeights.size(); ++s) {
      add(side * static_cast<double>(s), side * kSideWeights[s]);
    }
  }

  /// sum_c slope[k][c] d2u_c of every window k, (v + 1) x (v + 1) each.
  std::vector<double> Curvature(const std::vector<double>& slope) {
    const auto n = static_cast<std::size_t>(v_ + 1);
    std::vector<double> out(static_cast<std::size_t>(n_) * n * n, 0.0);
    slope_ = &slope;
    const bool values = term_.map_->own_slopes() == OwnSlopes::kNone;
    if (!term_.linear_ && values) {
      InParts(v_ * (v_ + 1) + 1, [&] { BlocksFromValues(&out); });
    } else if (!term_.linear_) {
      InParts(2 * v_, [&] { BlocksFromSlopes(&out); });
    }
    if (free_) InParts(2 * v_ + 1, [&] { Border(&out); });
    for (double& curvature : out) {
      if (!std::isfinite(curvature)) curvature = 0.0;  // a moved copy cannot be evaluated
    }
    return out;
  }

 private:
  // Windows by parts, so that so many copies of them are a bounded number of numbers.
  template <class Work>
  void InParts(int copies, const Work& work) {
    const std::size_t numbers = static_cast<std::size_t>(copies) * static_cast<std::size_t>(v_);
    const int part = static_cast<int>(std::max<std::size_t>(1, kMostNumbers / numbers));
    for (begin_ = 0; begin_ < n_; begin_ = end_) {
      end_ = std::min(n_, begin_ + part);
      work();
    }
    begin_ = 0;
    end_ = n_;
  }

  // Copies of all windows: each is the point, changed by `move(window, q)`.
  void Start(double h) {
    at_h_ = h;
    copies_ = 0;
    moved_.clear();
    t_.clear();
    window_.clear();
  }
  template <class Move>
  void Add(const Move& move) {
    for (int k = begin_; k < end_; ++k) {
      const std::size_t at = moved_.size();
      moved_.insert(moved_.end(), q_.begin() + k * v_, q_.begin() + (k + 1) * v_);
      move(k, &moved_[at]);
      t_.push_back(t0_ + first_block_[static_cast<std::size_t>(k)] * at_h_);
      window_.push_back(k);
    }
    ++copies_;
  }
  WindowBatch Batch() const {
    return {copies_ * (end_ - begin_), moved_.data(), at_h_, t_.data(), window_.data()};
  }
  std::vector<double> Values() const {
    std::vector<double> u(window_.size() * static_cast<std::size_t>(m_),
                          std::numeric_limits<double>::quiet_NaN());
    term_.map_->Value(Batch(), u.data());
    return u;
  }
  std::vector<double> ValuesAt(double h) {
    Start(h);
    Add([](int, double*) {});
    return Values();
  }
  // Variable i of a window.
  Bounded At(int k, int i) const {
    const int block = first_block_[static_cast<std::size_t>(k)];
    const int x = block * term_.shape_.block_size + i;
    return {q_[static_cast<std::size_t>(k * v_ + i)],
            input_.lower ? input_.lower[x] : -Bounded::kNone,
            input_.upper ? input_.upper[x] : Bounded::kNone};
  }
  Bounded Interval() const { return {h_, input_.h_lower, input_.h_upper}; }
  double Step(int k, int i, double share) const { return At(k, i).Step(share * term_.scale_); }
  bool HasRoom(int k, int i, double from, double to) const {
    const double step = Step(k, i, kFineStep);
    return At(k, i).HasRoom(from * step, to * step);
  }
  void Move(int k, int i, double steps, double share, double* q) const {
    q[i] = At(k, i).Clamped(q[i] + steps * Step(k, i, share));
  }
  void AddMoved(int i, double steps, double share) {
    Add([&](int k, double* q) { Move(k, i, steps, share, q); });
  }
  // For curvatures: near a bound all copies are moved inwards, so that both sides have room.
  void Centre(int k, double* q, double share) const {
    for (int i = 0; i < v_; ++i) q[i] = At(k, i).Middle(Step(k, i, share));
  }
  void AddCentred(int i, double steps, double share) {
    Add([&](int k, double* q) {
      Centre(k, q, share);
      Move(k, i, steps, share, q);
    });
  }

  void CallForSlopes(TermBlock* block) {
    constexpr int kCopies = static_cast<int>(kSteps.size());
    InParts(1 + kCopies * v_, [&] {
      Start(h_);
      Add([](int, double*) {});
      for (int i = 0; i < v_; ++i) {
        for (const double steps : kSteps) AddMoved(i, steps, kFineStep);
      }
      const std::vector<double> u = Values();
      std::copy_n(u.begin(), (end_ - begin_) * m_, block->u.begin() + begin_ * m_);
      const auto difference = [&](int k, int c, int i) {
        if (Step(k, i, kFineStep) == 0.0) return 0.0;
        if (!HasRoom(k, i, -2.0, 2.0)) return std::numeric_limits<double>::quiet_NaN();
        double sum = 0.0;
        for (int s = 0; s < kCopies; ++s) sum += kWeights[s] * u[Row(1 + kCopies * i + s, k, c)];
        return sum / Step(k, i, kFineStep);
      };
      SetSlopes(difference, block);
    });
    AskTheOtherSide(block);
  }

  template <class Slope>
  void SetSlopes(const Slope& slope, TermBlock* block) const {
    for (int k = begin_; k < end_; ++k) {
      for (int c = 0; c < m_; ++c) {
        double* du = block->slopes(k * m_ + c);
        for (int i = 0; i < v_; ++i) du[i] = slope(k, c, i);
      }
    }
  }

  /// Slopes that lack a copy, which cannot be evaluated or is beyond a bound: from above, else from
  /// below.
  void AskTheOtherSide(TermBlock* block) {
    constexpr int kCopies = static_cast<int>(kSideWeights.size());
    for (const double side : {1.0, -1.0}) {
      const auto spoilt = [&](int k, int c) {
        const double* du = block->slopes(k * m_ + c);
        return std::isfinite(block->u[k * m_ + c]) &&
               !std::all_of(du, du + v_, [](double x) { return std::isfinite(x); });
      };
      bool any = false;
      for (int k = 0; k < n_; ++k) {
        for (int c = 0; c < m_; ++c) any = any || spoilt(k, c);
      }
      if (!any) return;
      InParts(kCopies * v_, [&] {
        Start(h_);
        for (int i = 0; i < v_; ++i) {
          for (int s = 0; s < kCopies; ++s) AddMoved(i, side * s, kFineStep);
        }
        const std::vector<double> u = Values();
        SetSlopes(
            [&](int k, int c, int i) {
              const double known = block->slopes(k * m_ + c)[i];
              const double last = 4.0 * side;
              const bool has_room = HasRoom(k, i, std::min(0.0, last), std::max(0.0, last));
              if (std::isfinite(known) || !has_room) return known;
              double sum = 0.0;
              for (int s = 0; s < kCopies; ++s)
                sum += kSideWeights[s] * u[Row(kCopies * i + s, k, c)];
              return side * sum / Step(k, i, kFineStep);
            },
            block);
      });
    }
  }

  std::size_t Row(int copy, int k, int c) const {
    const auto window = static_cast<std::size_t>(copy) * static_cast<std::size_t>(end_ - begin_) +
                        static_cast<std::size_t>(k - begin_);
    return window * static_cast<std::size_t>(m_) + static_cast<std::size_t>(c);
  }
  // sum_c slope u_c of a copy of a window.
  double Sum(const std::vector<double>& u, int copy, int k) const {
    double sum = 0.0;
    for (int c = 0; c < m_; ++c) {
      const double slope = (*slope_)[static_cast<std::size_t>(k * m_ + c)];
      if (slope != 0.0) sum += slope * u[Row(copy, k, c)];
    }
    return sum;
  }
  double* BlockOf(std::vector<double>* out, int k) const {
    const auto n = static_cast<std::size_t>(v_ + 1);
    return &(*out)[static_cast<std::size_t>(k) * n * n];
  }

  void BlocksFromValues(std::vector<double>* out) {
    Start(h_);
    Add([&](int k, double* q) { Centre(k, q, kSecondStep); });
    for (int i = 0; i < v_; ++i) {
      AddCentred(i, 1.0, kSecondStep);
      AddCentred(i, -1.0, kSecondStep);
    }
    for (int i = 0; i < v_; ++i) {
      for (int j = i + 1; j < v_; ++j) {
        for (const double sign : {1.0, -1.0}) {
          Add([&](int k, double* q) {
            Centre(k, q, kSecondStep);
            Move(k, i, sign, kSecondStep, q);
            Move(k, j, sign, kSecondStep, q);
          });
        }
      }
    }
    const std::vector<double> u = Values();
    for (int k = begin_; k < end_; ++k) {
      double* to = BlockOf(out, k);
      const double middle = Sum(u, 0, k);
      const auto both = [&](int i) { return Sum(u, 1 + 2 * i, k) + Sum(u, 2 + 2 * i, k); };
      int copy = 1 + 2 * v_;
      for (int i = 0; i < v_; ++i) {
        const double step = Step(k, i, kSecondStep);
        to[i * (v_ + 1) + i] = (both(i) - 2.0 * middle) / (step * step);
        for (int j = i + 1; j < v_; ++j, copy += 2) {
          const double ends = Sum(u, copy, k) + Sum(u, copy + 1, k);
          const double mixed =
              (ends + 2.0 * middle - both(i) - both(j)) / (2.0 * step * Step(k, j, kSecondStep));
          to[i * (v_ + 1) + j] = to[j * (v_ + 1) + i] = mixed;
        }
      }
    }
  }

  void BlocksFromSlopes(std::vector<double>* out) {
    Start(h_);
    for (int i = 0; i < v_; ++i) {
      AddCentred(i, 1.0, kFirstStep);
      AddCentred(i, -1.0, kFirstStep);
    }
    const std::vector<double> du = MapSlopes();
    for (int k = begin_; k < end_; ++k) {
      double* to = BlockOf(out, k);
      for (int i = 0; i < v_; ++i) {
        for (int j = 0; j < v_; ++j) {
          const double difference = SlopeSum(du, 2 * i, k, j) - SlopeSum(du, 2 * i + 1, k, j);
          const double half = 0.5 * difference / (2.0 * Step(k, i, kFirstStep));
          to[i * (v_ + 1) + j] += half;
          to[j * (v_ + 1) + i] += half;
        }
      }
    }
  }
  // du of all copies.
  std::vector<double> MapSlopes() const {
    const std::size_t rows = window_.size() * static_cast<std::size_t>(m_);
    std::vector<double> u(rows), du_dh(rows), du(rows * static_cast<std::size_t>(v_));
    term_.map_->Jacobian(Batch(), u.data(), du.data(), du_dh.data());
    return du;
  }
  double SlopeSum(const std::vector<double>& du, int copy, int k, int i) const {
    double sum = 0.0;
    for (int c = 0; c < m_; ++c) {
      const double slope = (*slope_)[static_cast<std::size_t>(k * m_ + c)];
      const std::size_t at = Row(copy, k, c) * static_cast<std::size_t>(v_);
      if (slope != 0.0) sum += slope * du[at + static_cast<std::size_t>(i)];
    }
    return sum;
  }

  // With the interval: as differences of values, copies at one step up and one down.
  void Border(std::vector<double>* out) {
    const double step = Interval().Step(h_ * kSecondStep), h = Interval().Middle(step);
    const auto centre = [&](int k, double* q) { Centre(k, q, kSecondStep); };
    Start(h);
    Add(centre);
    const std::vector<double> middle = Values();
    std::vector<double> moved[2];
    for (const int side : {0, 1}) {
      Start(Interval().Clamped(h + (side == 0 ? step : -step)));
      Add(centre);
      for (int i = 0; i < v_; ++i) {
        AddCentred(i, 1.0, kSecondStep);
        AddCentred(i, -1.0, kSecondStep);
      }
      moved[side] = Values();
    }
    for (int k = begin_; k < end_; ++k) {
      double* to = BlockOf(out, k);
      const double ends = Sum(moved[0], 0, k) + Sum(moved[1], 0, k);
      to[v_ * (v_ + 1) + v_] = (ends - 2.0 * Sum(middle, 0, k)) / (step * step);
      for (int i = 0; i < v_; ++i) {
        const auto difference = [&](int side) {
          return Sum(moved[side], 1 + 2 * i, k) - Sum(moved[side], 2 + 2 * i, k);
        };
        to[i * (v_ + 1) + v_] =
            (difference(0) - difference(1)) / (4.0 * step * Step(k, i, kSecondStep));
      }
    }
  }

  const BatchTerm& term_;
  const TermInput& input_;
  double t0_, h_;
  bool free_;
  int n_, v_, m_;
  std::vector<int> first_block_;
  std::vector<double> q_;                       // [n][v]
  const std::vector<double>* slope_ = nullptr;  // [n][m]
  int begin_ = 0, end_;                         // windows of the part at hand
  double at_h_ = 1.0;
  int copies_ = 0;
  std::vector<double> moved_, t_;  // of all copies
  std::vector<int> window_;
};

BatchTerm::BatchTerm(TermInfo info, const BatchShape& shape, const AnyLoss& loss,
                     std::shared_ptr<BatchMap> map)
    : info_(std::move(info)),
      linear_(shape.linear),
      scale_(shape.scale),
      loss_(loss),
      map_(std::move(map)) {
  const auto require = [this](const char* name, int value, int low, int high) {
    if (value >= low && value <= high) return;
    throw std::invalid_argument("term " + info_.name + ": " + name + " is " +
                                std::to_string(value) + ", it must be " + std::to_string(low) +
                                " to " + std::to_string(high));
  };
  require("block_size", shape.block_size, 1, 1 << 16);
  require("window", shape.window, 1, kMaxWindow);
  require("outputs", shape.outputs, 1, 1 << 16);
  require("max_windows", shape.max_windows, 0, 1 << 24);
  if (!(shape.scale > 0.0) || !std::isfinite(shape.scale)) {
    throw std::invalid_argument("term " + info_.name + ": scale is " + std::to_string(shape.scale) +
                                ", it must be > 0 and finite");
  }
  if (!map_) throw std::invalid_argument("term " + info_.name + ": there is no map");
  shape_.block_size = shape.block_size;
  shape_.window = shape.window;
  shape_.outputs = shape.outputs;
  shape_.max_windows = shape.max_windows;
  shape_.uses_interval = shape.uses_interval;
  shape_.quadratic = shape.linear && IsQuadratic(loss);
  shape_.has_residual = LossHasResidual(loss);
  if (map_->own_slopes() == OwnSlopes::kNone) shape_.slope_error = kSlopeError;
}

LossBounds BatchTerm::bounds() const { return BoundsOf(loss_); }

double BatchTerm::nominal_row_weight() const { return NominalRowWeight(loss_); }

void BatchTerm::Place(TermBlock* block) const {
  const int windows = map_->windows(), first = map_->first_block();
  if (windows < 0 || windows > shape_.max_windows || first < 0) {
    throw std::length_error("term " + info_.name + ": " + std::to_string(windows) +
                            " windows from block " + std::to_string(first) +
                            " on, and it was sized for " + std::to_string(shape_.max_windows));
  }
  block->windows = windows;
  for (int k = 0; k < windows; ++k) block->first_block[k] = first + k;
}

void BatchTerm::Evaluate(const TermInput& input, const TermRequest& request, TermBlock* block,
                         const TermSums& sums) const {
  if (block->windows == 0) return;
  Differences at(*this, input, *block);
  const bool derivatives = request.want.gradient || request.want.residual;
  if (derivatives && !request.jacobian_known) {
    at.Slopes(block);
  } else {
    at.Values(block);
  }
  for (int k = 0; k < block->windows; ++k) {
    if (request.role == Role::kCost) EvaluateLoss(loss_, k, shape_, request, block);
    if (request.want.gradient) AddGradient(k, shape_, input, request, *block, sums);
  }
  if (!request.want.hessian || request.hessian_known) return;
  std::vector<double> slope, curvature;
  bool bends = false;
  for (int row = 0; row < block->rows(); ++row) {
    slope.push_back(SlopeOf(row, request, *block));
    bends = bends || slope.back() != 0.0;
  }
  bends = bends && !request.nominal_curvature && (!linear_ || UsesInterval(input));
  if (bends) curvature = at.Curvature(slope);
  const auto n = static_cast<std::size_t>(shape_.variables() + 1);
  for (int k = 0; k < block->windows; ++k) {
    AddHessian(k, shape_, input, request, *block,
               bends ? &curvature[static_cast<std::size_t>(k) * n * n] : nullptr, sums);
  }
}

}  // namespace touchdown::solvers
