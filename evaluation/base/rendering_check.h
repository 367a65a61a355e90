// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::evaluation {

/// Checks that an OpenGL context in memory can be made and used; nothing is drawn. Tried once per process. The first
/// answer holds for all threads. @throws BadInput if it cannot: one sentence with what the user can do.
/// @param who the part that needs rendering, for the sentence. @param way_out the end of the sentence: what works
/// without rendering; empty: nothing.
void RequireRendering(const std::string& who, const std::string& way_out);

/// Of flights with sensing: rendered. @throws as above
void RequireRenderedSensing();

}  // namespace touchdown::evaluation
