#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/failure.h"

namespace shaken::bench {

/// What the program is to do once the command line has been read.
using Work = std::function<ExitCode()>;

/// Each adds one subcommand to `app`, which sets `work` if it is the one that the user asked for.
void add_speed(CLI::App& app, Work& work);
void add_accuracy(CLI::App& app, Work& work);
void add_export(CLI::App& app, Work& work);
void add_effects(CLI::App& app, Work& work);
void add_hard(CLI::App& app, Work& work);

/// Adds the bench that `Bench` is: members declare(CLI::App&), which adds its options, and run() const.
template <class Bench>
void add_bench(CLI::App& app, Work& work, const char* name, const char* what, const char* footer) {
  const auto bench = std::make_shared<Bench>();
  CLI::App* command = app.add_subcommand(name, what);
  command->footer(footer);
  bench->declare(*command);
  command->callback([bench, &work] { work = [bench] { return bench->run(); }; });
}

/// What speaks against `word` as a number within `range`; empty if nothing does.
inline std::string number_problem(const std::string& word, std::pair<double, double> range) {
  double value = 0;
  if (!CLI::detail::lexical_cast(word, value)) return fmt::format("'{}' is not a number", word);
  if (value >= range.first && value <= range.second) return "";
  return fmt::format("{} is outside [{:.10g}, {:.10g}]", word, range.first, range.second);
}

/// A number, or a list of them ("4.5,2.5"), each of which must be within `range`. Where `value` is a plain number it
/// is the default, which the help shows.
template <class Number>
CLI::Option* add_number(CLI::App& app, const char* name, Number& value, const char* type,
                        std::pair<double, double> range, const char* help) {
  CLI::Option* option = app.add_option(name, value, help);
  option->type_name(type)->check([range](const std::string& word) { return number_problem(word, range); });
  if constexpr (std::is_arithmetic_v<Number>) option->capture_default_str();
  if constexpr (requires { value.push_back({}); }) option->delimiter(',')->allow_extra_args(false);
  return option;
}

/// A list of names ("newton,instant"), each of which must be one of `known`.
inline CLI::Option* add_names(CLI::App& app, const char* name, std::vector<std::string>& names, const char* type,
                              const std::vector<std::string>& known, const char* help) {
  return app.add_option(name, names, help)
      ->type_name(type)
      ->check(CLI::IsMember(known))
      ->delimiter(',')
      ->allow_extra_args(false);
}

/// A path in `value`; its default, if it has any, is in the help's words.
inline CLI::Option* add_path(CLI::App& app, const char* name, std::string& value, const char* type, const char* help) {
  return app.add_option(name, value, help)->type_name(type);
}

}  // namespace shaken::bench
