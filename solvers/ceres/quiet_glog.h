// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>

#include <glog/logging.h>

namespace touchdown::solvers {

/// While an instance lives, Ceres's warnings are not printed: they ignore its own option to be
/// silent. glog's level belongs to the process. So messages of others are lost too, unless they end
/// the process.
class QuietGlog {
 public:
  QuietGlog() {
    const std::lock_guard lock(mutex_);
    if (alive_++ > 0) return;
    before_ = FLAGS_minloglevel;
    FLAGS_minloglevel = google::GLOG_FATAL;
  }
  ~QuietGlog() {
    const std::lock_guard lock(mutex_);
    if (--alive_ == 0) FLAGS_minloglevel = before_;
  }
  QuietGlog(const QuietGlog&) = delete;
  QuietGlog& operator=(const QuietGlog&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int alive_ = 0;
  static inline int before_ = 0;
};

}  // namespace touchdown::solvers
