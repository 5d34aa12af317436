#include <fmt/format.h>

#include "base/keys/nearest.h"
#include "base/process.h"
#include "base/program.h"
#include "bench/bench.h"
#include "run/files/version.h"

namespace {

constexpr const char* kFooter = R"(Examples:
  shaken-bench speed --quick
  shaken-bench speed --help
  shaken-bench accuracy --quick

Exit codes: 0 done, 1 a check did not hold or something failed, 2 bad input.)";

/// What is wrong with the command line. An unknown bench comes before that none was chosen, which is all that CLI11
/// says.
std::string problem_text(const CLI::App& app, const CLI::ParseError& problem) {
  const std::vector<std::string> left_over = app.remaining();
  if (left_over.empty() || !app.get_subcommands().empty()) return problem.what();
  std::vector<std::string> names;
  for (const CLI::App* bench : app.get_subcommands(nullptr)) names.push_back(bench->get_name());
  return fmt::format("there is no bench '{}'{}", left_over.front(),
                     shaken::keys::did_you_mean(shaken::keys::nearest(left_over.front(), names)));
}

}  // namespace

int main(int argc, char** argv) {
  using namespace shaken;
  using namespace shaken::bench;
  go_on_as_wide_build(argv);
  Program app("shaken-bench", "Measures Shaken.", kFooter);
  app.set_version_flag("--version", std::string("shaken-bench ") + run::version());
  app.require_subcommand(1);
  app.get_formatter()->label("SUBCOMMAND", "BENCH");
  Work work;
  add_speed(app, work);
  add_accuracy(app, work);
  add_export(app, work);
  add_effects(app, work);
  add_hard(app, work);
  return app.run(
      argc, argv, [&] { return work(); }, [&](const CLI::ParseError& problem) { return problem_text(app, problem); });
}
