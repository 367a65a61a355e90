// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::evaluation {

/// Whether an OpenGL context in memory can be made and used; nothing is drawn. Tried once per process,
/// the first answer holds for all threads. @throws BadInput, one sentence with what the user can do, if
/// it cannot. @param who needs it, as the sentence shall name it. @param way_out what can be done without, as the sentence
/// shall end; empty: nothing.
void RequireRendering(const std::string& who, const std::string& way_out);

/// Of flights with sensing: rendered. @throws as above
void RequireRenderedSensing();

}  // namespace touchdown::evaluation
