// SPDX-License-Identifier: BSD-3-Clause
// OSMesa's software rasteriser. MuJoCo draws into framebuffer objects of its own, so that the
// context's own buffer stays a dummy of one tile.

#include "sim/rendering/gl_context.h"

#include <GL/osmesa.h>

#include <array>
#include <stdexcept>

namespace touchdown::sim {

class GlContext::Impl {
 public:
  Impl() : context_(OSMesaCreateContextExt(GL_RGBA, 24, 8, 0, nullptr)) {
    if (context_ == nullptr) {
      throw std::runtime_error("OSMesa could not make an off-screen OpenGL context.");
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { OSMesaDestroyContext(context_); }

  void MakeCurrent() {
    if (OSMesaGetCurrentContext() == context_) return;
    if (OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) != GL_TRUE) {
      throw std::runtime_error("OSMesa could not make its off-screen context current.");
    }
  }

 private:
  static constexpr int kSide = 64;  // [pixel]

  OSMesaContext context_;
  std::array<unsigned char, 4 * kSide * kSide> buffer_{};
};

GlContext::GlContext() : impl_(std::make_unique<Impl>()) {}
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;
GlContext::~GlContext() = default;

void GlContext::MakeCurrent() { impl_->MakeCurrent(); }

}  // namespace touchdown::sim
