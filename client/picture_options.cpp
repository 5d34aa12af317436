#include "client/picture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/plots_by_python.h"
#include "base/process.h"
#include "client/live/api_client.h"
#include "client/live/target.h"
#include "client/verb.h"
#include "client/verbs/in_python.h"
#include "render/style_keys.h"

namespace shaken::client {
void PictureOptions::declare(Arguments& arguments, bool films) {
  arguments.list("JOB", jobs, "A job, by the beginning of its id, or a run directory; several go side by side",
                 Names::kJobOrFolder, 1);
  arguments.option("-o,--out", out, "FILE", "Where to write; named after the job if left out", Names::kFile);
  arguments.option("--style", style_, value_name(render::style_keys().at("style")) + "|FILE",
                   "A style, or a file of one; the options below change it");
  for (const render::StyleKey& key : render::style_keys()) {
    if (key.path == "style" || (!films && render::is_for_films(key))) continue;
    const std::string name = render::option_of(key);
    if (key.form != keys::Form::kSwitch) {
      arguments.option(render::flags_of(key), values_[name], value_name(key), key.doc);
      continue;
    }
    arguments.flag("--" + name, switches_[name], key.doc);
    arguments.flag("--no-" + name, switches_["no-" + name], "Without it");
  }
  arguments.repeatable("--label", labels_, "TEXT", "Headline, one for each run; what was swept if left out");
  arguments.flag("--bare", bare_, "Only the box, filling the picture; --scale-bar puts a scale bar on it");
}

std::vector<std::string> PictureOptions::words(const std::vector<std::string>& labels) const {
  std::vector<std::string> words;
  if (!style_.empty()) words.push_back("--style=" + style_);
  for (const auto& [name, value] : values_) {
    if (!value.empty()) words.push_back(fmt::format("--{}={}", name, value));
  }
  for (const auto& [name, is_given] : switches_) {
    if (is_given) words.push_back("--" + name);
  }
  const std::vector<std::string>& headlines = labels_.empty() ? labels : labels_;
  const bool is_any = std::any_of(headlines.begin(), headlines.end(), [](const auto& text) { return !text.empty(); });
  for (std::size_t i = 0; is_any && i < headlines.size(); ++i) words.push_back("--label=" + headlines[i]);
  if (bare_) words.emplace_back("--bare");
  return words;
}

namespace {

Drawn find_one(const Context& context, const std::string& job) {
  if (is_run_directory(job)) {
    return {.directory = job, .name = std::filesystem::weakly_canonical(job).filename().string()};
  }
  ApiClient session(context.root());
  const Json found = find_job(session, job);
  Drawn drawn;
  drawn.id = found.at("id").get<std::string>();
  drawn.directory = found.at("directory").get<std::string>();
  drawn.name = short_id(drawn.id);
  drawn.state = text_of(found, "state");
  drawn.label = text_of(found, "label");
  drawn.sweep = text_of(found, "sweep");
  return drawn;
}

}  // namespace

std::string sweep_of(const Context& context, const std::vector<Drawn>& drawn) {
  const std::string& sweep = drawn.front().sweep;
  if (sweep.empty()) throw Failure(ExitCode::kBadInput, "--inset sweep takes jobs of a sweep, not run directories");
  std::vector<std::string> command = python_command("tables");
  command.insert(command.end(), {"inset", root_option(context)});
  for (const Drawn& one : drawn) command.push_back("--job=" + one.id);
  command.insert(command.end(), {"--", sweep});
  const Captured said = run_captured(command);
  constexpr std::string_view kBefore = "shaken: ";
  if (said.exit_code != 0) {
    const bool has_it = said.output.starts_with(kBefore);
    throw Failure(static_cast<ExitCode>(said.exit_code), said.output.substr(has_it ? kBefore.size() : 0));
  }
  return said.output;
}

std::vector<std::string> labels_of(const std::vector<Drawn>& drawn) {
  std::vector<std::string> labels;
  labels.reserve(drawn.size());
  for (const Drawn& one : drawn) labels.push_back(one.label.empty() && drawn.size() > 1 ? one.name : one.label);
  return labels;
}

std::vector<Drawn> find_drawn(const Context& context, const std::vector<std::string>& jobs) {
  std::vector<Drawn> drawn;
  drawn.reserve(jobs.size());
  for (const std::string& job : jobs) drawn.push_back(find_one(context, job));
  return drawn;
}

void PictureOptions::draw(const Context& context, const std::string& what, const std::vector<Drawn>& drawn,
                          const std::vector<std::pair<std::string, std::string>>& more,
                          const std::string& ending) const {
  std::vector<std::string> command{sibling_program("shaken-render").string(), what};
  for (const Drawn& one : drawn) command.push_back(one.directory);
  command.insert(command.end(), {"-o", out.empty() ? drawn.front().name + ending : out});
  for (const auto& [option, value] : more) {
    if (!value.empty()) command.push_back(fmt::format("{}={}", option, value));
  }
  if (const auto inset = values_.find("inset"); inset != values_.end() && inset->second == "sweep") {
    command.push_back("--sweep=" + sweep_of(context, drawn));
  }
  const std::vector<std::string> style = words(labels_of(drawn));
  command.insert(command.end(), style.begin(), style.end());
  become(command);
}

}  // namespace shaken::client
