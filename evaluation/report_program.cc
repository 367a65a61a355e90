// SPDX-License-Identifier: BSD-3-Clause
// Runs the distribution's Python as a child, without a shell: paths are arguments, not text. What
// the child prints goes to stderr, so that stdout stays one JSON document.
#include "touchdown/evaluation/report_program.h"

#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "touchdown/evaluation/shipped_files.h"

namespace touchdown::evaluation {

void DrawLanding(const std::string& record_path, const std::string& picture_path) {
  const std::string python = TOUCHDOWN_PYTHON;
  if (access(python.c_str(), X_OK) != 0) {
    throw std::runtime_error(
        fmt::format("--plot needs {}, which is missing: install python3-matplotlib.", python));
  }
  const std::vector<std::string> directories = PythonDirectories();
  if (directories.empty())
    throw std::runtime_error("--plot: the package touchdown_report is missing.");
  const std::filesystem::path directory = std::filesystem::path(picture_path).parent_path();
  if (!directory.empty()) std::filesystem::create_directories(directory);

  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("--plot: no child process could be started.");
  if (child == 0) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
    setenv("PYTHONPATH", directories.front().c_str(), 1);
    execl(python.c_str(), python.c_str(), "-m", "touchdown_report.landing", record_path.c_str(),
          picture_path.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(
        fmt::format("{} -m touchdown_report.landing failed (status {}): is python3-matplotlib "
                    "installed?",
                    python, WIFEXITED(status) ? WEXITSTATUS(status) : -1));
  }
}

}  // namespace touchdown::evaluation
