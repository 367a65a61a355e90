// SPDX-License-Identifier: BSD-3-Clause
// Python's output is not the program's output: stdout stays one JSON document, and a traceback becomes one sentence.
#include "evaluation/report/report_program.h"

#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/child_program.h"
#include "evaluation/report/interpreter.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {

namespace {

using Packages = std::vector<std::string>;

const Packages& ForPictures() {
  static const Packages packages = {"numpy", "matplotlib"};
  return packages;
}

const Packages& ForStudies() {
  static const Packages packages = {"numpy", "matplotlib", "pandas", "scipy", "statsmodels"};
  return packages;
}

// "PYTHONPATH=...": the user's own stays, behind, for the packages in it.
std::string PythonPath() {
  const std::vector<std::string> directories = PythonDirectories();
  if (directories.empty()) throw std::runtime_error("the package touchdown_report is missing");
  std::string path = std::string("PYTHONPATH=").append(directories.front());
  const char* const own = std::getenv("PYTHONPATH");
  if (own != nullptr && *own != '\0') path.append(":").append(own);
  return path;
}

// Runs `python -m module arguments...`.
void RunPython(const char* module, const std::vector<std::string>& arguments,
               const Packages& packages) {
  const std::string path = PythonPath();
  const std::string python = InterpreterWith(packages);
  std::vector<std::string> words = {python, "-m", module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const ChildEnd end = RunChild(words, {path}, std::numeric_limits<double>::infinity());
  if (end.failure.empty()) return;
  throw std::runtime_error(fmt::format("{} (by {})", end.failure, python));
}

// What `run` throws ends the sentence that `failure` begins.
void OrFail(const std::string& failure, const std::function<void()>& run) {
  try {
    run();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}.", failure, error.what()));
  }
}

// `option` is the one that named the picture.
void Draw(const char* module, const std::string& option, const std::string& input_path,
          const std::string& picture_path) {
  OrFail(fmt::format("{} {}: the picture was not drawn", option, picture_path), [&] {
    RunPython(module, {input_path, picture_path}, ForPictures());
  });
}

}  // namespace

void DrawFrom(const std::string& kept, const std::string& picture,
              const std::function<void(const std::string& table)>& write,
              const std::function<void(const std::string&, const std::string&)>& draw) {
  if (!kept.empty()) return draw(kept, picture);
  const AtomicFile unkept(picture + ".table");
  write(unkept.working_path());
  draw(unkept.working_path(), picture);
}

void DrawLanding(const std::string& record_path, const std::string& picture_path) {
  Draw("touchdown_report.landing", "--plot", record_path, picture_path);
}

void DrawComparison(const std::string& table_path, const std::string& picture_path) {
  Draw("touchdown_report.compare", "--picture", table_path, picture_path);
}

void DrawProblemSet(const std::string& table_path, const std::string& picture_path) {
  Draw("touchdown_report.problem_set", "--picture", table_path, picture_path);
}

void DrawGrowth(const std::string& table_path, const std::string& picture_path) {
  Draw("touchdown_report.growth", "--picture", table_path, picture_path);
}

void DrawPadStudy(const std::string& table_path, const std::string& picture_path) {
  Draw("touchdown_report.pad_study", "--picture", table_path, picture_path);
}

void DrawSweep(const std::string& table_path, const std::string& picture_path) {
  Draw("touchdown_report.sweep", "--picture", table_path, picture_path);
}

void DrawVehicle(const std::string& document_path, const std::string& picture_path) {
  Draw("touchdown_report.vehicle", "--picture", document_path, picture_path);
}

void DrawPlan(const std::string& document_path, const std::string& picture_path) {
  Draw("touchdown_report.plan", "--picture", document_path, picture_path);
}

void CheckStudyReport() {
  OrFail("The report could not be written yet", [] {
    PythonPath();
    InterpreterWith(ForStudies());
  });
}

void WriteStudyReport(const std::string& folder) {
  OrFail(fmt::format("{}: the report was not written", folder),
         [&] { RunPython("touchdown_report.study", {folder}, ForStudies()); });
}

}  // namespace touchdown::evaluation
