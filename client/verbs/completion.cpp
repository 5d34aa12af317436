#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include "base/plots_by_python.h"
#include "client/live/target.h"
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"
#include "scene/keys/fields.h"

namespace shaken::client {
namespace {

std::string offer(const std::string& words) {
  return fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$word\"))", words);
}

/// What `shaken completion WHAT` prints, and directories if asked for.
std::string ask(const char* what, bool with_folders = false) {
  return fmt::format("_shaken_names {}{}", what, with_folders ? "; COMPREPLY+=($(compgen -d -- \"$word\"))" : "");
}

std::string in_a_row(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// What bash is to offer for the value of `option`.
std::string action_of(const CLI::Option& option) {
  constexpr const char* kFiles = "COMPREPLY=($(compgen -f -- \"$word\"))";
  switch (meaning(option)) {
    case Names::kFile:
      return kFiles;
    case Names::kFolder:
      return "COMPREPLY=($(compgen -d -- \"$word\"))";
    case Names::kId:
      return ask("ids");
    case Names::kJob:
      return ask("jobs");
    case Names::kSweep:
      return ask("sweeps");
    case Names::kRun:
      return ask("ids", true);
    case Names::kJobOrFolder:
      return ask("jobs", true);
    case Names::kField:
      return ask("fields");
    case Names::kSetting: {
      std::string paths;
      for (const scene::Field& field : scene::fields()) paths += (paths.empty() ? "" : " ") + field.path + "=";
      return fmt::format("compopt -o nospace 2>/dev/null; {}", offer(paths));
    }
    case Names::kAnything:
      break;
  }
  const std::string words = in_a_row(choices(option));
  const bool or_file = option.get_type_name().ends_with("|FILE");
  if (words.empty()) return or_file ? kFiles : "";
  return or_file ? fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$word\") $(compgen -f -- \"$word\"))", words)
                 : offer(words);
}

/// After "-s PATH=": the words that the key takes. bash takes the "=" for a word of its own.
std::string values_of_keys() {
  std::string cases;
  for (const scene::Field& field : scene::fields()) {
    std::vector<std::string> words = field.names;
    if (field.form == keys::Form::kSwitch || field.form == keys::Form::kBlock) words = {"true", "false"};
    if (!words.empty()) cases += fmt::format("    {}) {}; return ;;\n", field.path, offer(in_a_row(words)));
  }
  return cases;
}

std::string all_names(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : " -") + name;
  for (const std::string& name : option.get_lnames()) names += (names.empty() ? "--" : " --") + name;
  return names;
}

/// A script that completes verbs, options, files and IDs of `app` in bash. IDs come from `shaken completion ids`.
std::string bash_completion(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : app.get_subcommands(nullptr)) {
    verbs += (verbs.empty() ? "" : " ") + verb->get_name();
    std::string options;
    std::string values;      // what follows an option
    std::string positional;  // what stands alone
    for (const CLI::Option* option : verb->get_options()) {
      const std::string names = all_names(*option);
      if (names.empty()) {
        if (positional.empty()) positional = action_of(*option);
        continue;
      }
      options += (options.empty() ? "" : " ") + names;
      if (option->get_type_size() == 0) continue;
      std::string pattern = names;
      for (std::size_t at; (at = pattern.find(' ')) != std::string::npos;) pattern.replace(at, 1, "|");
      const std::string action = action_of(*option);
      values += fmt::format("        {}) {}{}return ;;\n", pattern, action, action.empty() ? "" : "; ");
    }
    if (verb->get_prefix_command()) {  // only the other program knows
      cases += fmt::format("    {0}) _shaken_help shaken-{0} \"${{COMP_WORDS[@]:i+1:COMP_CWORD-i-1}}\" ;;\n",
                           verb->get_name());
      continue;
    }
    cases += fmt::format("    {})\n      case \"$previous\" in\n{}      esac\n", verb->get_name(), values);
    cases += fmt::format("      if [[ $word == -* ]]; then COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return; fi\n",
                         options);
    if (!positional.empty()) cases += fmt::format("      {}\n", positional);
    cases += "      ;;\n";
  }
  return fmt::format(R"sh(# Completion of the program `shaken` for bash. To have it in every new shell:
#   echo 'eval "$(shaken completion bash)"' >> ~/.bashrc

# Options and subcommands of the program "$@", as its help lists them.
_shaken_help() {{
  local help
  help=$("$@" --help 2>/dev/null)
  local previous=${{COMP_WORDS[COMP_CWORD-1]}} values=
  if [[ $previous == -* ]]; then
    values=$(sed -nE "s/^ +(-[a-zA-Z],)?$previous ([a-z0-9|]+\\|[a-z0-9|]+).*/\\2/p" <<< "$help" | tr '|' ' ')
  fi
  if [[ -n $values ]]; then
    COMPREPLY=($(compgen -W "$values" -- "$word"))
  elif [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$(sed -nE 's/^ +(-[a-zA-Z],)?(--[a-z][a-z-]*).*/\2/p' <<< "$help" | sort -u)" -- "$word"))
  else
    COMPREPLY=($(compgen -W "$(sed -nE 's/^  ([a-z]+) +[A-Z].*/\1/p' <<< "$help")" -- "$word") $(compgen -f -- "$word"))
  fi
}}
_shaken_program() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} sub=()
  COMPREPLY=()
  if ((COMP_CWORD > 1)) && [[ ${{COMP_WORDS[1]}} != -* ]]; then sub=("${{COMP_WORDS[1]}}"); fi
  _shaken_help "$1" "${{sub[@]}}"
}}
complete -o filenames -F _shaken_program shakend shaken-render shaken-worker shaken-web

# What the program lists under $1 (ids, jobs, ...), a line each, which nothing expands: a name may have blanks, which bash then escapes.
_shaken_names() {{
  local id typed=${{word//\\/}}
  typed=${{typed#[\"\']}}
  while IFS= read -r id; do
    if [[ $id == "$typed"* ]]; then COMPREPLY+=("$id"); fi
  done < <(shaken completion "$1" 2>/dev/null)
}}

_shaken() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} verb= i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    case ${{COMP_WORDS[i]}} in
      --root) ((i++)) ;;
      -*) ;;
      *) verb=${{COMP_WORDS[i]}}; break ;;
    esac
  done
  local key=
  if [[ $word == = ]]; then key=$previous word=; elif [[ $previous == = ]]; then key=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  case $key in
{}  esac
  if [[ $previous == --root ]]; then COMPREPLY=($(compgen -d -- "$word")); return; fi
  case $verb in
    "") COMPREPLY=($(compgen -W "{} --root --version --help" -- "$word")) ;;
{}  esac
}}
complete -o filenames -F _shaken shaken
)sh",
                     values_of_keys(), verbs, cases);
}

/// The same for zsh, through its bash emulation.
std::string zsh_completion(const CLI::App& app) {
  return "# For zsh: eval \"$(shaken completion zsh)\" in ~/.zshrc\n"
         "autoload -U +X compinit && compinit -u\n"
         "autoload -U +X bashcompinit && bashcompinit\n" +
         bash_completion(app);
}

/// Whether `name` may be offered to a shell: letters, digits, blanks and a few signs. What a shell expands is left out:
/// "$(...)" in somebody's scene could be carried out at the next Tab.
bool is_plain(const std::string& name) {
  static constexpr std::string_view kPlain = "._-+=,:@% ";
  return std::all_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 || std::isalnum(byte) != 0 || kPlain.find(c) != std::string_view::npos;
  });
}

class Completion : public Verb {
 public:
  VerbInfo info() const override {
    return {"completion", kHelpGroup, "Script that lets the shell complete verbs, options, files and IDs",
            "  eval \"$(shaken completion bash)\"     now, in this shell\n"
            "  echo 'eval \"$(shaken completion bash)\"' >> ~/.bashrc\n"
            "  echo 'eval \"$(shaken completion zsh)\"' >> ~/.zshrc\n"
            "  shaken completion ids                the IDs of sweeps and jobs, one a line; also sweeps, jobs, and\n"
            "                                       fields, of the newest sweep's results"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("WHAT", what_, "bash or zsh; or ids, sweeps, jobs, or fields, which the script asks for",
                       "bash|zsh|ids|sweeps|jobs|fields");
  }

  ExitCode run(const Context& context) override {
    std::ostream& out = context.console.out;
    if (what_ == "bash") {
      out << bash_completion(context.app);
    } else if (what_ == "zsh") {
      out << zsh_completion(context.app);
    } else if (what_ == "ids" || what_ == "sweeps" || what_ == "jobs") {
      ApiClient session(context.root());
      if (what_ != "jobs") print_sweeps(session, out);
      if (what_ != "sweeps") print_jobs(session, out);
    } else if (what_ == "fields") {
      std::vector<std::string> command = python_command("tables");
      command.insert(command.end(), {"fields", root_option(context)});
      return context.console.run_instead(context.console, command);
    } else {
      throw Failure(ExitCode::kBadInput,
                    fmt::format("no completion for '{}': bash, zsh, ids, sweeps, jobs or fields", what_));
    }
    return ExitCode::kOk;
  }

 private:
  static void print_sweeps(ApiClient& session, std::ostream& out) {
    const Json sweeps = session.get("/v1/sweeps");
    std::set<std::string> words;  // sweeps may share a name
    for (const Json& sweep : sweeps.at("sweeps")) {
      words.insert(sweep.at("id").get<std::string>());
      if (const std::string name = text_of(sweep, "name"); is_plain(name)) words.insert(name);
    }
    words.erase("");
    for (const std::string& word : words) out << word << "\n";
  }

  static void print_jobs(ApiClient& session, std::ostream& out) {
    const Json jobs = session.get("/v1/jobs");
    for (const Json& job : jobs.at("jobs")) out << short_id(job.at("id").get<std::string>()) << "\n";
  }

  std::string what_;
};

}  // namespace

std::unique_ptr<Verb> make_completion() { return std::make_unique<Completion>(); }

}  // namespace shaken::client
