#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/table.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

using Align = Table::Align;

/// The words between commas, without blanks round them.
std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> words = split(text, ',');
  for (std::string& word : words) {
    word.erase(0, std::min(word.find_first_not_of(' '), word.size()));
    word.erase(word.find_last_not_of(' ') + 1);
  }
  std::erase(words, "");
  return words;
}

std::string size_of(const Json& object) { return bytes_text(object.value("bytes", 0.0)); }

class Clean : public Verb {
 public:
  VerbInfo info() const override {
    return {
        "clean", kControlGroup, "Remove the directories of runs that have ended; their jobs stay in the history",
        "  shaken clean --dry-run                       what failed, was cancelled or timed out, and how large it is\n"
        "  shaken clean --older 30d                     of that, what ended 30 days ago or earlier; asks first\n"
        "  shaken clean --sweep s3 --state done --yes   the results of a sweep, without asking\n"
        "  shaken clean --unknown                       also what no job is known of, as after a loss of queue.db"};
  }

  void declare(Arguments& arguments) override {
    arguments.option("--state", states_, "STATES",
                     fmt::format("Of jobs in these states: {}, separated by commas; all but done if left out",
                                 fmt::join(words_of(shaken::has_ended), ", ")));
    arguments.option("--sweep", sweep_, "ID", "Only of this sweep", Names::kSweep);
    arguments.option("--older", older_, "TIME", "Only what ended at least so long ago: 30d, 12h");
    arguments.flag("--unknown", unknown_, "Remove also runs that the daemon's queue does not know");
    arguments.flag("--dry-run", dry_run_, "Only show what would go");
    arguments.flag("--yes", yes_, "Do not ask");
    arguments.flag("--json", json_, "Print the daemon's answer as JSON; asks nothing, so it needs --yes or --dry-run");
  }

  ExitCode run(const Context& context) override {
    Console& console = context.console;
    Json request = Json::object();
    if (!states_.empty()) request["states"] = listed(states_);
    if (!sweep_.empty()) request["sweep"] = sweep_;
    if (!older_.empty()) request["older_s"] = duration_option("--older", older_);
    if (unknown_) request["unknown"] = true;
    if (!yes_ && !dry_run_ && (json_ || console.in == nullptr)) {
      throw Failure(ExitCode::kBadInput,
                    "clean removes files, and there is nobody to ask: add --yes, or --dry-run to see what would go");
    }
    ApiClient session(context.root());
    Json dry = request;
    dry["dry_run"] = true;
    const Json found = session.post("/v1/clean", dry);
    if (json_ && dry_run_) console.out << json_text(found);
    if (!json_) show(found, console);
    Json only = Json::array();
    for (const Json& run : found.at("runs")) {
      if (unknown_ || run.value("known", true)) only.push_back(run.at("id"));
    }
    if (dry_run_ || only.empty()) return ExitCode::kOk;
    const std::string question = fmt::format("Remove {}, {}?", counted(only.size(), "run"), size_of(found));
    if (!yes_ && !console.agrees(question, false)) {
      console.err << "nothing removed\n";
      return ExitCode::kFailed;
    }
    request["only"] = only;  // what has been shown, and nothing else
    const Json answer = session.post("/v1/clean", request);
    if (json_) console.out << json_text(answer);
    return tell(answer, console);
  }

 private:
  void show(const Json& found, Console& console) const {
    const Json& runs = found.at("runs");
    if (runs.empty()) {
      console.out << "nothing to clean\n";
      return;
    }
    Table table({{"RUN"}, {"STATE"}, {"SIZE", Align::kRight}, {"SWEEP"}, {"POINT"}});
    int n_unknown = 0;
    for (const Json& run : runs) {
      const bool is_known = run.value("known", true);
      n_unknown += is_known ? 0 : 1;
      table.add_row({short_id(run.at("id").get<std::string>()),
                     run.at("state").is_null() ? "unknown" : text_of(run, "state"), size_of(run), text_of(run, "sweep"),
                     text_of(run, "label")});
    }
    console.out << table.text(console.width) << fmt::format("{} in all\n", size_of(found));
    if (n_unknown > 0 && !unknown_) {
      console.out << fmt::format("{} unknown to the queue, not counted: --unknown removes such runs too\n", n_unknown);
    }
    console.out << std::flush;
  }

  ExitCode tell(const Json& answer, Console& console) const {
    int n_removed = 0;
    int n_kept = 0;
    for (const Json& run : answer.at("runs")) {
      n_removed += run.value("removed", false) ? 1 : 0;
      if (run.value("removed", false)) continue;
      ++n_kept;
      console.err << fmt::format("{} stays: {}\n", short_id(run.at("id").get<std::string>()), text_of(run, "kept"));
    }
    if (!json_) console.out << fmt::format("{} removed, {}\n", n_removed, size_of(answer));
    return n_kept == 0 ? ExitCode::kOk : ExitCode::kFailed;
  }

  std::string states_;
  std::string sweep_;
  std::string older_;
  bool unknown_ = false;
  bool dry_run_ = false;
  bool yes_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_clean() { return std::make_unique<Clean>(); }

}  // namespace shaken::client
