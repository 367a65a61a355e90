// SPDX-License-Identifier: BSD-3-Clause
// The program's output goes to a file in memory. So the program never waits for a reader, and processes that it leaves
// running hold up no reader. It is spawned, not forked, because the rasteriser has threads. It stays in this process's
// group, so that a keyboard's signals end both.
#include "evaluation/base/child_program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "evaluation/base/words.h"

namespace touchdown::evaluation {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

std::vector<const char*> EnvironmentWith(const std::vector<std::string>& entries) {
  std::vector<const char*> all;
  for (const std::string& entry : entries) all.push_back(entry.c_str());
  for (char** own = environ; *own != nullptr; ++own) {
    const bool replaced = std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
      return entry.compare(0, entry.find('=') + 1, *own, entry.find('=') + 1) == 0;
    });
    if (!replaced) all.push_back(*own);
  }
  all.push_back(nullptr);
  return all;
}

// Of the file that the program wrote, from its beginning.
std::string LastLine(std::FILE* file) {
  std::rewind(file);
  std::string line, last;
  for (int letter = std::fgetc(file);; letter = std::fgetc(file)) {
    if (letter != EOF && letter != '\n') {
      line += static_cast<char>(letter);
      continue;
    }
    if (line.find_first_not_of(" \r\t") != std::string::npos) last.swap(line);
    if (letter == EOF) return last;
    line.clear();
  }
}

// False: it did not end within the limit, and was ended.
bool WaitFor(pid_t child, double limit_s, int* status) {
  const auto begin = std::chrono::steady_clock::now();
  while (waitpid(child, status, WNOHANG) == 0) {
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
    if (waited.count() > limit_s) {
      kill(child, SIGKILL);
      waitpid(child, status, 0);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

std::string WhyFailed(int status, const std::string& last_line) {
  if (WIFSIGNALED(status)) return SignalWords(WTERMSIG(status));
  if (WEXITSTATUS(status) == 0) return "";
  if (!last_line.empty()) return WithoutStop(last_line);
  return fmt::format("exit status {}", WEXITSTATUS(status));
}

}  // namespace

std::string FindOnPath(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder) / program;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) {
      return file.string();
    }
  }
  return "";
}

ChildEnd RunChild(const std::vector<std::string>& words,
                  const std::vector<std::string>& environment, double limit_s) {
  const std::unique_ptr<std::FILE, CloseFile> said(fdopen(memfd_create("said", MFD_CLOEXEC), "r"));
  if (said == nullptr) throw std::runtime_error("no file in memory could be made");
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  arguments.push_back(nullptr);
  const std::vector<const char*> variables = EnvironmentWith(environment);
  // Stdin last: where this process has none, the file may have its number.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(said.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  pid_t child = -1;
  const int failed = posix_spawn(&child, arguments.front(), &actions, nullptr,
                                 const_cast<char* const*>(arguments.data()),
                                 const_cast<char* const*>(variables.data()));
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return {fmt::format("it cannot be started ({})", std::strerror(failed)), ""};
  int status = 0;
  if (!WaitFor(child, limit_s, &status)) {
    return {fmt::format("it did not end within {} s", limit_s), ""};
  }
  const std::string last_line = LastLine(said.get());
  return {WhyFailed(status, last_line), last_line};
}

}  // namespace touchdown::evaluation
