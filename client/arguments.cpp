#include "client/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/failure.h"
#include "base/keys/units.h"
#include "base/text.h"

namespace shaken::client {
namespace {

/// A meaning is stored as the name of the value's type, which CLI11 keeps for every option.
constexpr std::array<std::pair<Names, const char*>, 9> kValueNames{{{Names::kFile, "FILE"},
                                                                    {Names::kFolder, "DIR"},
                                                                    {Names::kId, "ID"},
                                                                    {Names::kJob, "JOB"},
                                                                    {Names::kSweep, "SWEEP"},
                                                                    {Names::kRun, "ID|DIR"},
                                                                    {Names::kJobOrFolder, "JOB|DIR"},
                                                                    {Names::kField, "FIELD"},
                                                                    {Names::kSetting, "PATH=VALUE"}}};
std::string shown_value(const std::string& value_name, Names names) {
  return names == Names::kAnything ? value_name : Meaning(names).type;
}

/// The help shows a positional by its own name; the type beside it would repeat it.
constexpr const char* kNothing = " ";

}  // namespace

Meaning::Meaning(Names names) {
  const auto found = std::ranges::find(kValueNames, names, &std::pair<Names, const char*>::first);
  if (found != kValueNames.end()) type = found->second;
}

Names meaning(const CLI::Option& option) {
  for (const auto& [names, value_name] : kValueNames) {
    if (option.get_type_name() == value_name) return names;
  }
  return Names::kAnything;
}

std::vector<std::string> choices(const CLI::Option& option) {
  const std::string& name = option.get_type_name();
  if (name.find('|') == std::string::npos) return {};
  std::vector<std::string> words = split(name, '|');
  // Capitals stand for something, as N in "N|last".
  std::erase_if(words,
                [](const std::string& word) { return std::isupper(static_cast<unsigned char>(word.front())) != 0; });
  return words;
}

void Arguments::required(const std::string& name, std::string& value, const std::string& help, const Meaning& meaning) {
  app_.add_option(name, value, help)->required()->type_name(meaning.type)->option_text(kNothing);
}

void Arguments::optional(const std::string& name, std::string& value, const std::string& help, const Meaning& meaning) {
  app_.add_option(name, value, help)->type_name(meaning.type)->option_text(kNothing);
}

void Arguments::list(const std::string& name, std::vector<std::string>& values, const std::string& help,
                     const Meaning& meaning, int minimum) {
  app_.add_option(name, values, help)->type_name(meaning.type)->option_text(kNothing)->required(minimum > 0);
}

void Arguments::rest(std::vector<std::string>& words) {
  app_.fallthrough(false);
  app_.prefix_command();
  app_.parse_complete_callback([this_app = &app_, &words] { words = this_app->remaining(); });
}

void Arguments::option(const std::string& flags, std::string& value, const std::string& value_name,
                       const std::string& help, Names names) {
  app_.add_option(flags, value, help)->type_name(shown_value(value_name, names));
}

void Arguments::option(const std::string& flags, std::optional<int>& value, const std::string& value_name,
                       const std::string& help) {
  app_.add_option(flags, value, help)->type_name(value_name);
}

void Arguments::option(const std::string& flags, std::optional<double>& value, const std::string& value_name,
                       const std::string& help) {
  app_.add_option(flags, value, help)->type_name(value_name);
}

void Arguments::repeatable(const std::string& flags, std::vector<std::string>& values, const std::string& value_name,
                           const std::string& help, Names names) {
  // Without this, "-s a=1 FILE" would take FILE for a second value.
  app_.add_option(flags, values, help)->type_name(shown_value(value_name, names))->allow_extra_args(false);
}

void Arguments::flag(const std::string& flags, bool& value, const std::string& help) {
  app_.add_flag(flags, value, help);
}

void Arguments::optional(const std::string& name, const std::string& help, const Meaning& meaning) {
  without_variable_.push_back(app_.add_option(name, help)->type_name(meaning.type)->option_text(kNothing));
}

void Arguments::list(const std::string& name, const std::string& help, const Meaning& meaning) {
  without_variable_.push_back(app_.add_option(name, help)
                                  ->expected(1, CLI::detail::expected_max_vector_size)
                                  ->allow_extra_args()
                                  ->type_name(meaning.type)
                                  ->option_text(kNothing));
}

void Arguments::option(const std::string& flags, const std::string& value_name, const std::string& help, Names names) {
  without_variable_.push_back(app_.add_option(flags, help)->type_name(shown_value(value_name, names)));
}

void Arguments::repeatable(const std::string& flags, const std::string& value_name, const std::string& help,
                           Names names) {
  without_variable_.push_back(app_.add_option(flags, help)
                                  ->type_name(shown_value(value_name, names))
                                  ->expected(1, CLI::detail::expected_max_vector_size)
                                  ->allow_extra_args(false));
}

void Arguments::flag(const std::string& flags, const std::string& help) {
  without_variable_.push_back(app_.add_flag(flags, help));
}

void Arguments::options_of(const std::function<void(CLI::App&)>& declare) {
  const std::size_t n_before = app_.get_options().size();
  declare(app_);
  const std::vector<CLI::Option*> all = app_.get_options();
  without_variable_.insert(without_variable_.end(), all.begin() + static_cast<std::ptrdiff_t>(n_before), all.end());
}

void Arguments::hand_on(std::vector<std::string>& words) {
  app_.parse_complete_callback([options = without_variable_, &words] {
    std::vector<std::string> positionals;
    for (const CLI::Option* option : options) {
      const int most = option->get_items_expected_max();
      for (const std::string& value : option->results()) {
        if (option->get_positional()) {
          positionals.push_back(value);
        } else if (most == 0 ? option->as<bool>() : most > 1 || !value.empty()) {
          words.push_back("--" + option->get_lnames().front() + (most == 0 ? "" : "=" + value));
        }
      }
    }
    if (!positionals.empty()) words.emplace_back("--");
    words.insert(words.end(), positionals.begin(), positionals.end());
  });
}

double duration_option(const std::string& option, const std::string& text) {
  constexpr double kDay = 86400;  // scenes, which have the other units, are too short for it
  double seconds = 0;
  if (const auto written = keys::split_quantity(text); written && written->unit == "d") {
    seconds = written->number.value() * kDay;
  } else if (const auto time = keys::parse_quantity(text, keys::Dimension::kTime)) {
    seconds = *time;
  } else {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("{}: {} (write 90s, 10min, 2h or 30d)", option, time.error().message));
  }
  if (!(seconds > 0)) throw Failure(ExitCode::kBadInput, fmt::format("{}: '{}' is no time", option, text));
  return seconds;
}

}  // namespace shaken::client
