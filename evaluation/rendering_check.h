// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::evaluation {

/// Tries to render off screen. @throws BadInput, one sentence with what the user can do, if this
/// machine cannot. @param who needs it, as the sentence shall name it.
void RequireRendering(const std::string& who);

}  // namespace touchdown::evaluation
