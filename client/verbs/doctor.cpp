#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "client/checkup.h"
#include "client/live/json.h"
#include "client/slurm_estimate.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

struct Shown {
  const char* word;
  Colour colour;
};
/// A finding's level, to programs and people.
const Shown& shown(const CheckResult& finding) {
  static constexpr std::array<Shown, 3> kLevels{
      // in order
      {{"ok", Colour::kGreen}, {"warn", Colour::kYellow}, {"fail", Colour::kRed}}};
  return kLevels.at(static_cast<std::size_t>(finding.level));
}

class Doctor : public Verb {
 public:
  VerbInfo info() const override {
    return {"doctor", kHelpGroup, "Check this machine: programs, daemon, live state, drawing, disk",
            "  shaken doctor                 programs, daemon, live state, drawing, disk\n"
            "  shaken doctor --executor slurm    also what runs in Slurm need; starts a moment's job there\n"
            "  shaken doctor --json",
            "0 it can simulate, 1 something makes that impossible, 2 bad input"};
  }

  void declare(Arguments& arguments) override {
    arguments.option("--executor", executor_, "local|slurm", "Also check what runs need there");
    arguments.flag("--json", json_, "Print the findings as JSON");
  }

  ExitCode run(const Context& context) override {
    const bool in_slurm = is_slurm(executor_);
    std::vector<CheckResult> findings = checkup(context.root());
    if (in_slurm) {
      for (CheckResult& finding : slurm_checkup(context.root())) findings.push_back(std::move(finding));
    }
    Console& console = context.console;
    Json list = Json::array();
    for (const CheckResult& finding : findings) {
      list.push_back({{"check", finding.what},
                      {"level", shown(finding).word},
                      {"message", finding.message},
                      {"remedy", finding.remedy}});
      if (json_) continue;
      console.out << fmt::format("{}  {:<14}{}\n",
                                 console.painted(shown(finding).colour, fmt::format("{:<4}", shown(finding).word)),
                                 finding.what, finding.message);
      if (!finding.remedy.empty()) console.out << fmt::format("{:<20}-> {}\n", "", finding.remedy);
    }
    if (json_) console.out << json_text(Json{{"checks", list}});
    const bool failed = std::any_of(findings.begin(), findings.end(), [](const CheckResult& finding) {
      return finding.level == CheckResult::Level::kFail;
    });
    return failed ? ExitCode::kFailed : ExitCode::kOk;
  }

 private:
  std::string executor_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_doctor() { return std::make_unique<Doctor>(); }

}  // namespace shaken::client
