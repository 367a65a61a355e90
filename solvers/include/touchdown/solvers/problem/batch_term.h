// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "touchdown/solvers/problem/loss.h"
#include "touchdown/solvers/problem/term.h"

namespace touchdown::solvers {

/// Windows at which an inner map is asked: those of a term, or the same several times, each a little moved.
struct WindowBatch {
  int size = 0;                 ///< n
  const double* q = nullptr;    ///< [n][w][d], the blocks of each window
  double h = 1.0;               ///< knot interval, the same for all [s]
  const double* t = nullptr;    ///< [n], absolute time of each window's first block [s]
  const int* window = nullptr;  ///< [n], which window of the term it is, from 0
};

/// What of its derivatives an inner map has by itself.
enum class OwnSlopes {
  kNone,
  kBlocks,  ///< du by the blocks
  kAll,     ///< and du_dh by the interval, with the share of t = t0 + first_block h
};

/// An inner map that is asked for all windows at once: for languages in which a call takes longer
/// than the computation inside it.
class BatchMap {
 public:
  virtual ~BatchMap() = default;

  /// Windows that are active now, and the block at which the first of them starts; the others follow block by block.
  virtual int windows() const = 0;
  virtual int first_block() const = 0;

  /// u [n][m].
  virtual void Value(const WindowBatch& batch, double* u) const = 0;
  virtual OwnSlopes own_slopes() const { return OwnSlopes::kNone; }
  /// u [n][m], du [n][m][w d] and, of kAll, du_dh [n][m].
  virtual void Jacobian(const WindowBatch& /*batch*/, double* /*u*/, double* /*du*/,
                        double* /*du_dh*/) const {}
};

struct BatchShape {
  int block_size = 3;          ///< scalars in a block, d
  int window = 1;              ///< consecutive blocks that the map sees, w <= kMaxWindow
  int outputs = 1;             ///< m
  int max_windows = 0;         ///< most windows it can ever have
  bool uses_interval = false;  ///< u depends on h or t
  bool linear = false;         ///< u is affine in the blocks at a fixed h
  double scale = 1.0;          ///< change of a block's number over which u is smooth, > 0
};

/// A term of a BatchMap. Derivatives that the map does not give are found by central differences:
/// all windows and variables in one call, and a few calls for the interval. For a u that is smooth
/// over `scale`, slopes are good to about 1e-12 of u over scale. Curvatures are good to 1e-7 of u
/// over scale^2 from values, to 1e-9 from the map's own slopes. If a moved copy is not finite,
/// slopes are found from the other side, and the curvature is left out. Copies keep to the
/// variables' bounds: near one, slopes are one-sided, and a curvature is that of a point up to a
/// step of 1e-4 scale further inside. A fixed variable has neither. Allocates at every evaluation.
class BatchTerm : public Term {
 public:
  /// Throws std::invalid_argument on a size out of range or without a map.
  BatchTerm(TermInfo info, const BatchShape& shape, const AnyLoss& loss,
            std::shared_ptr<BatchMap> map);

  const TermInfo& info() const override { return info_; }
  const TermShape& shape() const override { return shape_; }
  LossBounds bounds() const override;
  double nominal_row_weight() const override;
  void Place(TermBlock* block) const override;
  void Evaluate(const TermInput& input, const TermRequest& request, TermBlock* block,
                const TermSums& sums) const override;

  void set_loss(const AnyLoss& loss) { loss_ = loss; }

 private:
  class Differences;
  bool UsesInterval(const TermInput& input) const {
    return input.free_interval && shape_.uses_interval;
  }

  TermInfo info_;
  TermShape shape_;
  bool linear_;
  double scale_;
  AnyLoss loss_;
  std::shared_ptr<BatchMap> map_;
};

}  // namespace touchdown::solvers
