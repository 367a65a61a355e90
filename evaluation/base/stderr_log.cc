// SPDX-License-Identifier: BSD-3-Clause
// One place writes to stderr, so that lines of the log and the line that is written over do not mix. Each text is one
// write, so the output of another process is before or after it.
#include "evaluation/base/stderr_log.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string_view>

#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace touchdown::evaluation {
namespace {

constexpr char kPrefix[] = "touchdown: ";
constexpr char kClearLine[] = "\r\x1b[K";

void WriteToStderr(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;  // no reader is left
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

std::size_t TerminalColumns() {
  constexpr std::size_t kUsual = 80;
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : kUsual;
}

// In UTF-8: every byte but those that go on with a letter.
bool BeginsLetter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

std::size_t LettersIn(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), BeginsLetter));
}

// A line that reaches the edge would go on in the next one, which is not cleared. Where there is little room, the text goes
// before the program's name.
std::string FitToTerminal(std::string_view text) {
  const std::size_t room = TerminalColumns() - 1;
  std::string line = std::string(kPrefix).append(text);
  if (LettersIn(line) <= room) return line;
  line = text;
  std::size_t letters = 0;
  const auto end = std::find_if(line.begin(), line.end(), [&](char byte) {
    if (BeginsLetter(byte)) ++letters;
    return letters > room;
  });
  line.erase(end, line.end());
  return line;
}

class StderrSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  StderrSink() { set_pattern_(std::string(kPrefix).append("%v")); }

  void Show(const std::string& text) {
    const std::lock_guard lock(mutex_);
    status_ = FitToTerminal(text);
    WriteToStderr(std::string(kClearLine).append(status_));
  }

  void End() {
    const std::lock_guard lock(mutex_);
    if (status_.empty()) return;
    status_.clear();
    WriteToStderr("\n");
  }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    const std::string_view text(line.data(), line.size());
    if (status_.empty()) return WriteToStderr(text);
    WriteToStderr(std::string(kClearLine).append(text).append(status_));
  }
  void flush_() override {}

  std::string status_;  // empty: none is shown
};

const std::shared_ptr<StderrSink>& TheSink() {
  static const auto sink = std::make_shared<StderrSink>();
  return sink;
}

}  // namespace

void LogToStderr() {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("touchdown", TheSink()));
}

bool StderrIsTerminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

void ShowStatus(const std::string& text) { TheSink()->Show(text); }

void EndStatus() { TheSink()->End(); }

}  // namespace touchdown::evaluation
