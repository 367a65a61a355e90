// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace touchdown::evaluation {

/// Draws a picture with `draw(table, picture)`, one of those below. The table, or document, is the
/// one at `kept`. If `kept` is empty, `write` writes one beside the picture, and it is removed
/// afterwards. @throws what `write` and `draw` throw.
void DrawFrom(const std::string& kept, const std::string& picture,
              const std::function<void(const std::string& table)>& write,
              const std::function<void(const std::string&, const std::string&)>& draw);

/// Draws the landing picture of a record through the Python package touchdown_report.
/// @throws std::runtime_error with one sentence: Python or the package missing, or why it failed.
void DrawLanding(const std::string& record_path, const std::string& picture_path);

/// Draws the pictures of a comparison's table (compare_table.h). @throws as DrawLanding
void DrawComparison(const std::string& table_path, const std::string& picture_path);

/// Draws the picture of a comparison on a set of known problems (reference_table.h). @throws as DrawLanding
void DrawProblemSet(const std::string& table_path, const std::string& picture_path);

/// Draws the picture of a replanning study's part growth (replan_report.h). @throws as DrawLanding
void DrawGrowth(const std::string& table_path, const std::string& picture_path);

/// Draws the picture of a study of the pad filter from its table (pad_report.h). @throws as
/// DrawLanding
void DrawPadStudy(const std::string& table_path, const std::string& picture_path);

/// Draws the outcome of a sweep from its table (trial_store.h). @throws as DrawLanding
void DrawSweep(const std::string& table_path, const std::string& picture_path);

/// Draws the picture of a solved step from its document (plan_report.h). @throws as DrawLanding
void DrawPlan(const std::string& document_path, const std::string& picture_path);

/// Draws a vehicle from its document (vehicle_check.h). @throws as DrawLanding
void DrawVehicle(const std::string& document_path, const std::string& picture_path);

/// Checks that the report of a study can be written. @throws std::runtime_error naming the packages that are missing
void CheckStudyReport();

/// Writes report, tables and figures of a flown study into its folder (study_run.h). @throws as DrawLanding
void WriteStudyReport(const std::string& folder);

}  // namespace touchdown::evaluation
