// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

namespace touchdown::sim {

/// An OpenGL context in memory: needs no display and no GPU. Belongs to the thread that made it,
/// which may have several.
class GlContext {
 public:
  /// Throws std::runtime_error if OSMesa cannot make one.
  GlContext();
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;
  ~GlContext();

  /// OpenGL calls of this thread then go to this context. Throws std::runtime_error if OSMesa
  /// refuses.
  void MakeCurrent();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::sim
