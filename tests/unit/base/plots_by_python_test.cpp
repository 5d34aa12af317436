#include "base/plots_by_python.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "base/failure.h"
#include "base/paths.h"
#include "base/scratch_folder.h"
#include "tests/support/good.h"

namespace shaken {
namespace {

using ::testing::_;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

/// A program in the place of Python, for as long as this lives.
class InPlaceOfPython {
 public:
  explicit InPlaceOfPython(const std::string& script) {
    const auto program = folder_.path() / "python3";
    std::ofstream(program) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    setenv("SHAKEN_PYTHON", program.c_str(), 1);
  }
  ~InPlaceOfPython() { unsetenv("SHAKEN_PYTHON"); }

 private:
  ScratchFolder folder_;
};

/// What is told where nothing was drawn.
Failure failure_of(const std::string& script) {
  const InPlaceOfPython python(script);
  return test::thrown_by<Failure>([] { plots_by_python({"runs"}); });
}

TEST(PlotsByPython, HandsOverItsWordsAndItsInput) {
  const InPlaceOfPython python("shift 3; echo \"$@\"; cat; printf 'plots/a.png\\n'\n");
  EXPECT_THAT(plots_by_python({"bench", "a.json"}, "{}\n"), ElementsAre("bench a.json", "{}", "plots/a.png"));
}

TEST(PythonCommand, SaysHowThePackageIsHad) {
  EXPECT_EQ(python_command("plots").back(), shipped_python() / "shaken/plots/__main__.py");
  EXPECT_THAT([] { (void)python_command("nothing"); },
              testing::ThrowsMessage<Failure>(HasSubstr("is not there: `apt install python3-shaken`")));
}

TEST(PlotsByPython, TellsInItsWordsWhyNothingWasDrawn) {
  EXPECT_EQ(test::said_with(ExitCode::kFailed, failure_of("echo there is nothing to plot yet; exit 1\n")),
            "there is nothing to plot yet");
  EXPECT_EQ(test::said_with(ExitCode::kBadInput, failure_of("echo one; echo two; exit 2\n")), "one\ntwo");
}

TEST(PlotsByPython, OfATracebackTheLastLineIsTold) {
  const Failure failure = failure_of("echo 'Traceback (most recent call last):'; echo 'ValueError: so'; exit 1\n");
  EXPECT_EQ(failure.code, ExitCode::kFailed);
  EXPECT_THAT(failure.what(), HasSubstr("ended with exit code 1: ValueError: so"));
  EXPECT_THAT(failure_of("kill -9 $$\n").what(), HasSubstr("ended with exit code 137"));
}

TEST(PythonCommand, HasTheInterpreterThatIsChosenAsItIs) {
  setenv("SHAKEN_PYTHON", "/opt/python", 1);
  EXPECT_THAT(python_command("plots"),
              ElementsAre("/opt/python", "-W", "ignore", EndsWith("shaken/plots/__main__.py")));
  setenv("SHAKEN_PYTHON", "", 1);
  EXPECT_THAT(python_command("plots"), ElementsAre(HasSubstr("python3"), "-s", "-E", "-W", "ignore", _));
  unsetenv("SHAKEN_PYTHON");
}

}  // namespace
}  // namespace shaken
