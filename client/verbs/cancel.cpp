// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "client/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Cancel : public Verb {
 public:
  VerbInfo info() const override {
    return {"cancel", kControlGroup, "Cancel queued and running jobs; what they have measured stays",
            "  shaken cancel 1f0c            one job, by the beginning of its id\n"
            "  shaken cancel s3 s4           all jobs of two sweeps\n"
            "  shaken submit FILE            queues cancelled points again; they go on from their checkpoint"};
  }

  void declare(Arguments& arguments) override {
    arguments.list("ID", ids_, "Sweeps (id or name) and jobs", Names::kId, 1);
    arguments.flag("--json", json_, "Print the daemon's answers as JSON");
  }

  ExitCode run(const Context& context) override {
    ApiClient session(context.root());
    // All names are looked up before the first job is stopped: a slip in the last one must not cost the others.
    std::vector<Target> targets;
    for (const std::string& id : ids_) targets.push_back(find_target(session, id));
    Json answers = Json::array();
    for (const Target& target : targets) {
      const Json answer = session.post(target.path + "/cancel", Json::object());
      const int cancelled = answer.at("cancelled").get<int>();
      answers.push_back({{"target", target.title()}, {"cancelled", cancelled}});
      if (json_) continue;
      context.console.out << (cancelled > 0 ? fmt::format("{}: {} cancelled\n", target.title(),
                                                          cancelled == 1 ? "1 job" : fmt::format("{} jobs", cancelled))
                                            : fmt::format("{}: nothing left to cancel\n", target.title()));
    }
    if (json_) context.console.out << json_text(Json{{"targets", answers}});
    return ExitCode::kOk;
  }

 private:
  std::vector<std::string> ids_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_cancel() { return std::make_unique<Cancel>(); }

}  // namespace shaken::client
