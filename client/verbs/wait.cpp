#include "client/live/target.h"
#include "client/verbs/verbs.h"
#include "client/waiting.h"

namespace shaken::client {
namespace {

class Wait : public Verb {
 public:
  VerbInfo info() const override {
    return {"wait", kControlGroup, "Wait until jobs have ended; exit code 0 only if all are done",
            "  shaken wait                   for every job that has not ended yet\n"
            "  shaken wait s3 && shaken plot s3\n"
            "  shaken wait 1f0c --timeout 10min",
            "0 all are done, 1 some are not, or the time is over; 2 bad input, 3 no daemon"};
  }

  void declare(Arguments& arguments) override {
    arguments.list("ID", ids_, "Sweeps (id or name) and jobs; every unfinished job if left out", Names::kId, 0);
    arguments.option("--timeout", timeout_, "TIME", "Give up after this time (exit code 1); the jobs go on");
  }

  ExitCode run(const Context& context) override {
    std::optional<double> timeout;
    if (!timeout_.empty()) timeout = duration_option("--timeout", timeout_);
    ApiClient session(context.root());
    std::vector<Target> targets = find_targets(session, ids_);
    if (ids_.empty()) {
      for (const std::string& state : words_of(is_on_its_way)) {
        const Json answer = session.get("/v1/jobs?state=" + state);
        for (const Json& job : answer.at("jobs")) {
          targets.push_back({"/v1/jobs/" + job.at("id").get<std::string>(), Json{{"job", job}}, false});
        }
      }
    }
    return wait_for(session, std::move(targets), timeout, context.console);
  }

 private:
  std::vector<std::string> ids_;
  std::string timeout_;
};

}  // namespace

std::unique_ptr<Verb> make_wait() { return std::make_unique<Wait>(); }

}  // namespace shaken::client
