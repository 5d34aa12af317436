#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "base/table.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

std::string local_time(std::int64_t utime) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::localtime(static_cast<std::time_t>(utime / 1'000'000)));
}

class JobHistory : public Verb {
 public:
  VerbInfo info() const override {
    return {"history", kControlGroup, "What became of a job: every change of its state, when, and why",
            "  shaken history 1f0c           one job, by the beginning of its id\n"
            "  shaken history 1f0c --json    for programs"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("JOB", id_, "A job, by the beginning of its id", Names::kJob);
    arguments.flag("--json", json_, "Print the daemon's answer as JSON");
  }

  ExitCode run(const Context& context) override {
    ApiClient session(context.root());
    const Json job = find_job(session, id_);
    const Json answer = session.get(fmt::format("/v1/jobs/{}/history", url_encoded(job.at("id").get<std::string>())));
    if (json_) {
      context.console.out << json_text(answer);
      return ExitCode::kOk;
    }
    Table table({{"WHEN"}, {"ATTEMPT", Table::Align::kRight}, {"STATE"}, {"WHY"}});
    for (const Json& change : answer.at("changes")) {
      table.add_row({local_time(change.at("utime").get<std::int64_t>()), std::to_string(change.value("attempt", 0)),
                     text_of(change, "to"), text_of(change, "cause")});
    }
    context.console.out << table.text(context.console.width);
    if (const std::string limits = limits_text(job); !limits.empty()) context.console.out << limits << '\n';
    const std::string reason = text_of(job, "reason");
    if (text_of(job, "state") == "queued" && !reason.empty()) context.console.out << "now: " << reason << '\n';
    return ExitCode::kOk;
  }

 private:
  std::string id_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_history() { return std::make_unique<JobHistory>(); }

}  // namespace shaken::client
