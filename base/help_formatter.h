// Of programs that include CLI11 anyway: its header costs seconds.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

#include "base/text.h"

namespace shaken {

/// Help as every program of Shaken prints it: 80 columns wide, with what a value is called ("N", "local|slurm") beside
/// the option, and its default and what it needs at the end of the description.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return wrapped_help(CLI::Formatter::make_help(app, std::move(name), mode));
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    if (!option->get_option_text().empty()) return " " + option->get_option_text();
    if (option->get_type_size() == 0) return "";
    const bool is_list = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    return " " + get_label(value_name(option->get_type_name())) + (is_list ? " ..." : "");
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    std::string text = option->get_description();
    if (option->get_type_size() != 0 && !option->get_default_str().empty()) {
      text += " [default: " + option->get_default_str() + "]";
    }
    for (const CLI::Option* other : option->get_needs()) text += "; needs " + other->get_name();
    for (const CLI::Option* other : option->get_excludes()) text += "; not with " + other->get_name();
    return text;
  }

 private:
  /// CLI11 adds what is checked: "INT:INT in [1 - 9]" is a number, "TEXT:{local,slurm}" is one of two words.
  static std::string value_name(const std::string& type) {
    const std::size_t colon = type.find(':');
    const std::size_t brace = type.find('{');
    if (brace != std::string::npos && type.find('}') != std::string::npos) {
      std::string words = type.substr(brace + 1, type.find('}') - brace - 1);
      std::replace(words.begin(), words.end(), ',', '|');
      return words;
    }
    const std::string name = type.substr(0, colon);
    if (name == "INT" || name == "UINT" || name == "FLOAT") return "N";
    const bool is_one_name =  // ADDRESS:PORT
        colon != std::string::npos && std::all_of(type.begin() + static_cast<std::ptrdiff_t>(colon) + 1, type.end(),
                                                  [](char c) { return c >= 'A' && c <= 'Z'; });
    return is_one_name ? type : name;
  }
};

}  // namespace shaken
