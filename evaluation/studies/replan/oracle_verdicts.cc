// SPDX-License-Identifier: BSD-3-Clause
// A line of the file: set, kind, seed, and a letter for each scene from 0 on.
// - p, w, m: a plan was found along a path, a wide path or a motion.
// - e: the end is blocked. s: the start leaves no time to stop. x: no plan was found.
#include "evaluation/studies/replan/oracle_verdicts.h"

#include <charconv>
#include <fstream>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/words.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

constexpr char kHead[] = "set,kind,seed,verdicts";
constexpr std::pair<char, const char*> kFoundBy[] = {
    {'p', "path"}, {'w', "wide path"}, {'m', "motion"}};
constexpr char kEndBlocked = 'e', kCannotStop = 's', kNone = 'x';

char LetterOf(const OracleVerdict& verdict) {
  for (const auto& [letter, name] : kFoundBy) {
    if (verdict.found && verdict.found_by == name) return letter;
  }
  return verdict.end_blocked ? kEndBlocked : verdict.cannot_stop ? kCannotStop : kNone;
}

std::optional<OracleVerdict> VerdictOf(char letter) {
  OracleVerdict verdict;
  for (const auto& [known, name] : kFoundBy) {
    if (letter != known) continue;
    verdict.found = true;
    verdict.found_by = name;
    return verdict;
  }
  verdict.end_blocked = letter == kEndBlocked;
  verdict.cannot_stop = letter == kCannotStop;
  const bool known = letter == kNone || verdict.end_blocked || verdict.cannot_stop;
  return known ? std::optional(verdict) : std::nullopt;
}

bool IsUsual(const SceneOptions& scenes) {
  const SceneOptions usual;
  return scenes.horizon == usual.horizon && scenes.resolution == usual.resolution &&
         scenes.density == usual.density;
}

}  // namespace

OracleVerdicts::OracleVerdicts(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw BadInput(fmt::format("{}: cannot be read.", path));
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line[0] == '#' || line == kHead) continue;
    const std::vector<std::string> cells = Split(line, ',');
    std::uint64_t seed = 0;
    if (cells.size() != 4 ||
        std::from_chars(cells[2].data(), cells[2].data() + cells[2].size(), seed).ec !=
            std::errc()) {
      throw BadInput(
          fmt::format("{}:{}: must be {}, the seed a whole number.", path, number, kHead));
    }
    for (const char letter : cells[3]) {
      if (VerdictOf(letter)) continue;
      throw BadInput(fmt::format("{}:{}: verdicts: '{}' must be one of p, w, m, e, s, x.", path,
                                 number, letter));
    }
    verdicts_[{cells[0], cells[1], seed}] = cells[3];
  }
}

std::optional<OracleVerdict> OracleVerdicts::Find(const SceneOptions& scenes, int index) const {
  if (!IsUsual(scenes)) return std::nullopt;
  const auto found = verdicts_.find({scenes.set, scenes.kind.name, scenes.seed});
  if (found == verdicts_.end()) return std::nullopt;
  const auto at = static_cast<std::size_t>(index);
  return at < found->second.size() ? VerdictOf(found->second[at]) : std::nullopt;
}

void OracleVerdicts::Add(const SceneOptions& scenes, const std::vector<ReplanRow>& rows) {
  if (!IsUsual(scenes)) {
    throw BadInput("--verdicts: a file of them is of the usual horizon, resolution and density.");
  }
  std::string& letters = verdicts_[{scenes.set, scenes.kind.name, scenes.seed}];
  letters.clear();
  for (const ReplanRow& row : rows) {
    if (row.oracle) letters += LetterOf(*row.oracle);
  }
}

void OracleVerdicts::Write(const std::string& path) const {
  AtomicFile file(path);
  std::ofstream out(file.working_path());
  out << "# Is there a plan? Verdicts of the oracle on the scenes of touchdown study replan "
         "(docs/replan_study.md), a letter a scene.\n"
      << kHead << '\n';
  for (const auto& [key, letters] : verdicts_) {
    const auto& [set, kind, seed] = key;
    out << fmt::format("{},{},{},{}\n", set, kind, seed, letters);
  }
  out.close();
  if (!out) throw BadInput(fmt::format("{}: cannot be written.", path));
  file.Commit();
}

OracleVerdicts StandardOracleVerdicts() { return OracleVerdicts(DataPath("replan_oracle.csv")); }

}  // namespace touchdown::evaluation
