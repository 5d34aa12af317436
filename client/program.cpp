#include "client/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

#include "base/help_formatter.h"
#include "base/keys/nearest.h"
#include "base/text.h"
#include "client/live/json.h"
#include "client/verbs/verbs.h"
#include "run/files/version.h"

namespace shaken::client {
namespace {

constexpr const char* kFooter = R"(Examples:
  shaken init scene.json && shaken validate scene.json
  shaken submit scene.json -s rods.area_fraction=0.55:0.75:0.05 --wait
  shaken watch && shaken results && shaken plot

Exit codes:
  0 done   1 failed   2 bad input   3 no daemon   130 interrupted by Ctrl-C
  of a run: 97 no room on the disk, 98 an error of the system that may pass,
  99 stopped with a checkpoint; the same command goes on
Environment:
  SHAKEN_ROOT      the daemon's root directory
  LCM_DEFAULT_URL  the bus of the live state
  NO_COLOR         no colours
`shaken VERB --help` (or `shaken help VERB`) tells more.)";

std::vector<std::string> verb_names(const Verbs& verbs) {
  std::vector<std::string> names;
  names.reserve(verbs.size());
  for (const auto& verb : verbs) names.emplace_back(verb->info().name);
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Most verbs of two groups ask the daemon.
std::string exit_codes_of(const VerbInfo& info) {
  if (info.exit_codes != nullptr) return info.exit_codes;
  const std::string_view group = info.group;
  return std::string(kCommonExitCodes) + (group == kControlGroup || group == kResultsGroup ? ", 3 no daemon" : "");
}

/// CLI11 ends the help of the program with a newline, that of a verb without.
std::string with_one_newline(std::string text) {
  text.erase(text.find_last_not_of('\n') + 1);
  return text + "\n";
}

/// The verbs of the program and the CLI11 application that fills their options.
class CommandLine {
 public:
  CommandLine();

  /// The verb that `arguments` (without the program's name) call for, its options filled in; none if they asked for
  /// help or the version, which is then printed. Throws Failure (kBadInput) with a suggestion if they make no sense.
  Verb* parse(std::vector<std::string> arguments, Console& console);
  /// As given with --root, or empty.
  const std::string& root() const { return root_; }
  const CLI::App& app() const { return app_; }

 private:
  CLI::App app_{"Simulates shaken granular nematics: sweeps, live state, plots, movies.", "shaken"};
  const Verbs verbs_ = make_verbs();
  std::string root_;
};

CommandLine::CommandLine() {
  // Left-overs come back to parse(), which can say more about them than CLI11.
  app_.allow_extras();
  app_.require_subcommand(0, 1);
  app_.fallthrough();
  app_.set_version_flag("--version", std::string("shaken ") + run::version());
  app_.add_option("--root", root_, "The daemon's root directory")->type_name("DIR");
  app_.footer(kFooter);
  app_.formatter(std::make_shared<HelpFormatter>());
  app_.get_formatter()->label("SUBCOMMAND", "VERB");
  for (const auto& verb : verbs_) {
    const VerbInfo info = verb->info();
    CLI::App* app = app_.add_subcommand(info.name, info.summary)->group(info.group);
    app->allow_extras(false);
    app->footer(fmt::format("Examples:\n{}\n\nExit codes: {}.", info.examples, exit_codes_of(info)));
    Arguments arguments(*app);
    verb->declare(arguments);
  }
}

Verb* CommandLine::parse(std::vector<std::string> arguments, Console& console) {
  if (!arguments.empty() && arguments.front() == "help") {  // `help run` is `run --help`
    arguments.erase(arguments.begin());
    const std::vector<std::string> verbs = verb_names(verbs_);
    const bool is_known = arguments.empty() || std::find(verbs.begin(), verbs.end(), arguments.front()) != verbs.end();
    if (is_known) arguments.emplace_back("--help");
  }
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants a vector
  try {
    app_.parse(arguments);
  } catch (const CLI::CallForHelp&) {
    console.out << with_one_newline(app_.help());
    return nullptr;
  } catch (const CLI::Success& asked) {
    app_.exit(asked, console.out, console.err);
    return nullptr;
  } catch (const CLI::ParseError& error) {
    const auto used = app_.get_subcommands();
    const std::string verb = used.empty() ? "" : used.front()->get_name() + " ";
    throw Failure(ExitCode::kBadInput, fmt::format("{} (see `shaken {}--help`)", error.what(), verb));
  }

  const auto used = app_.get_subcommands();
  std::vector<std::string> left_over = app_.remaining(true);
  // What follows "--" is no option, which CLI11 knows; the mark itself it hands back.
  const bool hands_on = !used.empty() && used.front()->get_prefix_command();  // Arguments::rest
  if (const auto mark = std::find(left_over.begin(), left_over.end(), "--"); !hands_on && mark != left_over.end()) {
    left_over.erase(mark);
  }
  if (used.empty()) {
    if (left_over.empty()) {
      console.err << with_one_newline(app_.help()) << '\n';
      throw Failure(ExitCode::kBadInput, "a verb is missing");
    }
    const std::string& word = left_over.front();
    const bool is_option = word.starts_with('-');
    throw Failure(
        ExitCode::kBadInput,
        fmt::format("unknown {} '{}'{} (see `shaken --help`)", is_option ? "option" : "verb", word,
                    keys::did_you_mean(keys::nearest(word, is_option ? option_names(app_) : verb_names(verbs_)))));
  }
  const std::string name = used.front()->get_name();
  if (!left_over.empty() && !hands_on) {
    const std::string& word = left_over.front();
    std::string hint;
    if (word.starts_with("--")) {
      std::vector<std::string> names = option_names(*used.front());
      for (std::string& of_program : option_names(app_)) names.push_back(std::move(of_program));
      hint = keys::did_you_mean(keys::nearest(word, names));
    }
    throw Failure(ExitCode::kBadInput,
                  fmt::format("{} does not understand '{}'{} (see `shaken {} --help`)", name, word, hint, name));
  }
  const auto verb = std::find_if(verbs_.begin(), verbs_.end(), [&](const auto& v) { return v->info().name == name; });
  return verb->get();
}

}  // namespace

Verbs make_verbs() {
  Verbs verbs;
#define SHAKEN_VERB(name) verbs.push_back(make_##name());
  SHAKEN_VERBS(SHAKEN_VERB)
#undef SHAKEN_VERB
  return verbs;
}

ExitCode run_program(const std::vector<std::string>& arguments, Console& console) {
  ExitCode code = ExitCode::kOk;
  std::string message;
  try {
    CommandLine command_line;
    if (Verb* verb = command_line.parse(arguments, console)) {
      // the programs that it starts look there, too
      if (!command_line.root().empty()) setenv("SHAKEN_ROOT", command_line.root().c_str(), 1);
      const Context context{console, command_line.root(), command_line.app()};
      code = verb->run(context);
    }
  } catch (const Failure& failure) {
    code = failure.code;
    message = failure.what();
  } catch (const Json::exception& error) {
    code = ExitCode::kFailed;
    message =
        fmt::format("an answer of the daemon is not as expected ({}): is it of another version than this client ({})?",
                    error.what(), run::version());
  } catch (const std::exception& error) {
    code = ExitCode::kFailed;
    message = error.what();
  }
  const bool wants_json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
  if (!message.empty() && wants_json) {
    console.out << json_text(Json{{"error", message}, {"exit_code", static_cast<int>(code)}});
  }
  console.out.flush();
  message.erase(message.find_last_not_of('\n') + 1);  // lists of problems end each with one
  if (!message.empty()) console.err << "shaken: " << printable(message, Lines::kMany) << "\n";
  // The reader of a pipe has gone: say nothing, but do not claim success.
  if (!console.out.good() && code == ExitCode::kOk) code = ExitCode::kFailed;
  return code;
}

}  // namespace shaken::client
