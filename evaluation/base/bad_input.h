// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace touchdown::evaluation {

/// The user's input cannot be used: a scenario file, a --set or another argument. The message is
/// one sentence. It names file, line, key and allowed range, where they apply. Exit status 2.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace touchdown::evaluation
