#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace shaken::client {

/// What an argument names, for shell completion.
enum class Names {
  kAnything,  ///< or one of some words, where the value's name in the help lists them: "tiny|desk|paper"; with
              ///< "|FILE" also a file
  kFile,
  kFolder,
  kId,           ///< a sweep or a job of the daemon
  kJob,          ///< a job
  kSweep,        ///< a sweep
  kRun,          ///< a sweep, a job, or a run directory
  kJobOrFolder,  ///< a job, or a run directory
  kField,        ///< a field of results
  kSetting,      ///< PATH=VALUE, with a key of the scene
};

/// One of these, or one of some words: "bash|zsh".
struct Meaning {
  Meaning(Names names);                        // NOLINT(google-explicit-constructor): one is meant by the other
  Meaning(const char* words) : type(words) {}  // NOLINT(google-explicit-constructor): likewise
  std::string type;                            ///< as which CLI11 keeps it
};

/// Declares the command line of a verb. Keeps CLI11 out of the verbs, but for that which completes the others': its
/// header costs seconds per source file. The variables must outlive the parsing; one that is not given keeps its value.
class Arguments {
 public:
  explicit Arguments(CLI::App& app) : app_(app) {}

  void required(const std::string& name, std::string& value, const std::string& help, const Meaning& meaning);
  void optional(const std::string& name, std::string& value, const std::string& help, const Meaning& meaning);
  /// Any number of them, at least `minimum`.
  void list(const std::string& name, std::vector<std::string>& values, const std::string& help, const Meaning& meaning,
            int minimum);

  /// The same without a variable, of a verb that hands its words on.
  void optional(const std::string& name, const std::string& help, const Meaning& meaning);
  void list(const std::string& name, const std::string& help, const Meaning& meaning);
  void option(const std::string& flags, const std::string& value_name, const std::string& help,
              Names names = Names::kAnything);
  void repeatable(const std::string& flags, const std::string& value_name, const std::string& help,
                  Names names = Names::kAnything);
  void flag(const std::string& flags, const std::string& help);
  /// Options that `declare` adds, as the program does to which the verb hands its words on.
  void options_of(const std::function<void(CLI::App&)>& declare);
  /// What was given of those that were declared so: "--name=value", "--flag", then "--" and the positionals
  /// if there are any. An empty value of an option that is given once is none.
  void hand_on(std::vector<std::string>& words);

  /// Everything from the first word on, options too, as it stands: for a verb that hands its words on.
  void rest(std::vector<std::string>& words);

  /// `names` like "-o,--out"; `value_name` as shown in the help.
  void option(const std::string& flags, std::string& value, const std::string& value_name, const std::string& help,
              Names names = Names::kAnything);
  void option(const std::string& flags, std::optional<int>& value, const std::string& value_name,
              const std::string& help);
  void option(const std::string& flags, std::optional<double>& value, const std::string& value_name,
              const std::string& help);
  /// May be given several times, each time with one value.
  void repeatable(const std::string& flags, std::vector<std::string>& values, const std::string& value_name,
                  const std::string& help, Names names = Names::kAnything);
  void flag(const std::string& flags, bool& value, const std::string& help);

 private:
  CLI::App& app_;
  std::vector<CLI::Option*> without_variable_;
};

/// How an argument's meaning is kept in its CLI11 option, for verbs/completion.cpp to read.
Names meaning(const CLI::Option& option);
/// The words that an option takes, where its value's name lists them.
std::vector<std::string> choices(const CLI::Option& option);

/// Seconds of wall time from "10min", "2h", "30d" or "90 s"; a number alone is in seconds. `option` is named in the
/// message. Throws Failure (kBadInput) for anything else, and unless it is more than nothing.
double duration_option(const std::string& option, const std::string& text);

}  // namespace shaken::client
