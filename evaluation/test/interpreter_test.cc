// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/report/interpreter.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/report/report_program.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kHasAll[] = "echo lacks\n";

// A folder for interpreters that are shell scripts, and an environment that names none.
class Interpreters : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const char* name : {"TOUCHDOWN_PYTHON", "VIRTUAL_ENV", "CONDA_PREFIX", "PYTHONPATH"}) {
      Set(name, "");
    }
    Set("PATH", folder_.string());
  }

  void TearDown() override {
    for (const auto& [name, value] : before_) {
      value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
    }
    fs::remove_all(folder_);
  }

  void Set(const std::string& name, const std::string& value) {
    const char* const old = std::getenv(name.c_str());
    before_.try_emplace(name, old == nullptr ? std::nullopt : std::optional<std::string>(old));
    setenv(name.c_str(), value.c_str(), 1);
  }

  std::string Path(const std::string& file) const { return (folder_ / file).string(); }

  std::string Make(const std::string& file, const std::string& script) const {
    const fs::path path = folder_ / file;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << "#!/bin/sh\n" << script;
    fs::permissions(path, fs::perms::owner_all);
    return path.string();
  }

  std::vector<std::string> Asked() const {
    std::vector<std::string> all;
    for (const Interpreter& one : InterpretersToAsk()) {
      all.push_back(one.named_by + ": " + one.path);
    }
    return all;
  }

  static std::string Refusal(const std::vector<Interpreter>& interpreters,
                             const std::vector<std::string>& packages, double patience_s = 60.0) {
    try {
      FirstWith(packages, interpreters, patience_s);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  }

 private:
  const fs::path folder_ =
      fs::path(::testing::TempDir()) /
      std::string("touchdown_")
          .append(::testing::UnitTest::GetInstance()->current_test_info()->name());
  std::map<std::string, std::optional<std::string>> before_;
};

TEST_F(Interpreters, AnActiveEnvironmentIsBeforePathAndTheBuildsDefaultLast) {
  EXPECT_THAT(Asked(), ElementsAre(HasSubstr("the build's default: /")));
  const std::string on_path = Make("python3", kHasAll);
  const std::string conda = Make("conda/bin/python3", kHasAll);
  const std::string venv = Make("venv/bin/python3", kHasAll);
  Set("CONDA_PREFIX", Path("conda"));
  Set("VIRTUAL_ENV", Path("venv"));
  EXPECT_THAT(Asked(), ElementsAre("VIRTUAL_ENV: " + venv, "CONDA_PREFIX: " + conda,
                                   "PATH: " + on_path, HasSubstr("the build's default: /")));
}

TEST_F(Interpreters, OneThatIsNamedIsAskedAlone) {
  const std::string on_path = Make("python3.12", kHasAll);
  Set("VIRTUAL_ENV", Path("venv"));
  Set("TOUCHDOWN_PYTHON", "/no/such/python");
  EXPECT_THAT(Asked(), ElementsAre("TOUCHDOWN_PYTHON: /no/such/python"));
  Set("TOUCHDOWN_PYTHON", "python3.12");
  EXPECT_THAT(Asked(), ElementsAre("TOUCHDOWN_PYTHON: " + on_path));
  Set("TOUCHDOWN_PYTHON", "python3.99");
  EXPECT_THAT(Asked(), ElementsAre("TOUCHDOWN_PYTHON: python3.99"));
}

TEST_F(Interpreters, OfAnEnvironmentThatHasNoneTheUsualOneIsNamed) {
  Set("VIRTUAL_ENV", Path("venv"));
  EXPECT_EQ(Asked().front(), "VIRTUAL_ENV: " + Path("venv/bin/python3"));
  const std::string python = Make("venv/bin/python", kHasAll);
  EXPECT_EQ(Asked().front(), "VIRTUAL_ENV: " + python);
  const std::string python3 = Make("venv/bin/python3", kHasAll);
  EXPECT_EQ(Asked().front(), "VIRTUAL_ENV: " + python3);
}

// An environment that is active is on PATH, too.
TEST_F(Interpreters, NoneIsAskedTwice) {
  const std::string venv = Make("venv/bin/python3", kHasAll);
  Set("VIRTUAL_ENV", Path("venv"));
  Set("PATH", Path("venv/bin"));
  EXPECT_THAT(Asked(), ElementsAre("VIRTUAL_ENV: " + venv, HasSubstr("the build's default")));
}

TEST_F(Interpreters, TheFirstThatHasAllPackagesIsTaken) {
  const Interpreter poor{Make("poor", "echo lacks matplotlib\n"), "A"};
  const Interpreter rich{
      Make("rich", "[ \"$1 $3 $4 $5\" = '-c numpy matplotlib ' ] && echo lacks\n"), "B"};
  const Interpreter never{Make("never", "echo asked > " + Path("trace") + "; echo lacks\n"), "C"};
  const Interpreter found = FirstWith({"numpy", "matplotlib"}, {poor, rich, never}, 60.0);
  EXPECT_EQ(found.path, rich.path);
  EXPECT_EQ(found.named_by, "B");
  EXPECT_FALSE(fs::exists(Path("trace")));
}

TEST_F(Interpreters, OfEachIsSaidWhatItLacksAndHowThatIsInstalled) {
  const std::string venv = Make("venv/bin/python3", "echo lacks numpy scipy\n");
  const std::string on_path = Make("python3", "echo noise >&2\necho lacks scipy\n");
  EXPECT_EQ(Refusal({{venv, "VIRTUAL_ENV"}, {on_path, "PATH"}}, {"numpy", "scipy"}),
            venv + " (VIRTUAL_ENV) lacks numpy, scipy (" + venv + " -m pip install numpy scipy); " +
                on_path + " (PATH) lacks scipy (" + on_path + " -m pip install scipy)");
}

TEST_F(Interpreters, ARealOneIsAskedWithoutImport) {
  const Interpreter system = InterpretersToAsk().back();
  EXPECT_EQ(FirstWith({"json", "email"}, {system}, 60.0).path, system.path);
  std::ofstream(Path("broken.py")) << "raise ImportError('imported')\n";
  fs::create_directories(Path("mere_folder"));
  Set("PYTHONPATH", Path(""));
  EXPECT_EQ(FirstWith({"broken"}, {system}, 60.0).path, system.path);
  EXPECT_THAT(Refusal({system}, {"json", "mere_folder", "other"}),
              HasSubstr(" (the build's default) lacks mere_folder, other ("));
  if (!system.path.starts_with("/usr/bin/")) GTEST_SKIP() << "it is not the distribution's";
  EXPECT_THAT(Refusal({system}, {"other", "more"}),
              EndsWith("(apt install python3-other python3-more)"));
}

TEST_F(Interpreters, OneThatDoesNotWorkIsPassedAndNamed) {
  const Interpreter good{Make("good", kHasAll), "B"};
  const std::pair<std::string, std::string> scripts[] = {
      {"kill -SEGV $$\n", "does not work: signal 11 (Segmentation fault)"},
      {"echo SyntaxError: invalid syntax >&2; exit 1\n",
       "does not work: SyntaxError: invalid syntax"},
      {"exit 3\n", "does not work: exit status 3"},
      {"echo hello\n", "does not answer as Python 3 does"},
      {"exit 0\n", "does not answer as Python 3 does"}};
  for (const auto& [script, reason] : scripts) {
    const Interpreter bad{Make("bad", script), "A"};
    EXPECT_EQ(FirstWith({"numpy"}, {bad, good}, 60.0).path, good.path);
    EXPECT_EQ(Refusal({bad}, {"numpy"}), bad.path + " (A) " + reason);
  }
  EXPECT_EQ(Refusal({{"/no/such/python", "A"}}, {"numpy"}),
            "/no/such/python (A) does not work: it cannot be started (No such file or directory)");
}

TEST_F(Interpreters, OneThatHangsIsPassedAndNamed) {
  const Interpreter hung{Make("hung", "exec /bin/sleep 100\n"), "A"};
  const Interpreter good{Make("good", kHasAll), "B"};
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(Refusal({hung}, {"numpy"}, 0.2),
            hung.path + " (A) does not work: it did not end within 0.2 s");
  // Enough for a script on a loaded machine.
  EXPECT_EQ(FirstWith({"numpy"}, {hung, good}, 2.0).path, good.path);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(taken.count(), 80.0);
}

// One test, because the kept value lasts for the process.
TEST_F(Interpreters, AReportAsksUntilOneIsFoundAndKeepsIt) {
  const std::string log = Path("log");
  const std::string answers = "echo \"$*\" | /usr/bin/tail -n 1 >> " + log + "\n";
  const std::string python = Make("python", answers + "echo lacks scipy\n");
  Set("TOUCHDOWN_PYTHON", python);
  const auto refusal = [](const auto& report) -> std::string {
    try {
      report();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal(CheckStudyReport), "The report could not be written yet: " + python +
                                           " (TOUCHDOWN_PYTHON) lacks scipy (" + python +
                                           " -m pip install scipy).");
  // Once it is installed it is found, and once found not asked again.
  Make("python", answers +
                     "case $1 in\n"
                     "-c) echo lacks ;;\n"
                     "-m) echo \"$PYTHONPATH\" >> " +
                     log +
                     "; echo Trace; echo it broke.; exit 1 ;;\n"
                     "esac\n");
  Set("PYTHONPATH", "/mine:/too");
  CheckStudyReport();
  CheckStudyReport();
  EXPECT_EQ(refusal([] { WriteStudyReport("folder"); }),
            "folder: the report was not written: it broke (by " + python + ").");
  EXPECT_EQ(refusal([] { DrawLanding("a b.db", "$c.png"); }),
            "--plot $c.png: the picture was not drawn: it broke (by " + python + ").");
  std::vector<std::string> lines;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  const std::string study = " numpy matplotlib pandas scipy statsmodels";
  const auto path = ::testing::AllOf(EndsWith("python:/mine:/too"), Not(HasSubstr("::")));
  EXPECT_THAT(
      lines, ElementsAre(EndsWith(study), EndsWith(study), "-m touchdown_report.study folder", path,
                         EndsWith(" numpy matplotlib"), "-m touchdown_report.landing a b.db $c.png",
                         path));
}

}  // namespace
}  // namespace touchdown::evaluation
