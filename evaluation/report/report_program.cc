// SPDX-License-Identifier: BSD-3-Clause
// Runs the distribution's Python as a child, without a shell: paths are arguments, not text. What
// the child prints is read from a pipe: stdout stays one JSON document, and a traceback becomes one
// sentence.
#include "evaluation/report/report_program.h"

#include <array>
#include <cerrno>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "evaluation/base/atomic_file.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {

namespace {

// Everything that can be read until the other end is closed.
std::string ReadAll(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

// A Python traceback says what is wrong in its last line.
std::string LastLine(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return "it gave no reason";
  const std::size_t begin = text.rfind('\n', end);
  return text.substr(begin + 1, end - begin);
}

// Runs `python -m module arguments...`; `failure` begins the sentence of what went wrong.
void RunPython(const char* module, const std::vector<std::string>& arguments,
               const std::string& failure) {
  const auto fail = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("{}: {}.", failure, why));
  };
  const std::string python = TOUCHDOWN_PYTHON;
  if (access(python.c_str(), X_OK) != 0) {
    fail(fmt::format("{} is missing (install python3-matplotlib)", python));
  }
  const std::vector<std::string> directories = PythonDirectories();
  if (directories.empty()) fail("the package touchdown_report is missing");
  std::vector<const char*> words = {python.c_str(), "-m", module};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);

  std::array<int, 2> ends;
  if (pipe(ends.data()) != 0) fail("no pipe could be opened");
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    setenv("PYTHONPATH", directories.front().c_str(), 1);
    execv(python.c_str(), const_cast<char* const*>(words.data()));
    _exit(127);
  }
  close(ends[1]);
  const std::string said = ReadAll(ends[0]);
  close(ends[0]);
  if (child < 0) fail("no child process could be started");
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail(LastLine(said));
}

// `option` is the one that named the picture.
void Draw(const char* module, const std::string& option, const std::string& input_path,
          const std::string& picture_path) {
  RunPython(module, {input_path, picture_path},
            fmt::format("{} {}: the picture was not drawn", option, picture_path));
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
  RunPython("touchdown_report.study", {"--check"}, "The report could not be written yet");
}

void WriteStudyReport(const std::string& folder) {
  RunPython("touchdown_report.study", {folder},
            fmt::format("{}: the report was not written", folder));
}

}  // namespace touchdown::evaluation
