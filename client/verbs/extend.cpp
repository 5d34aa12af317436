#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Extend : public Verb {
 public:
  VerbInfo info() const override {
    return {"extend", kControlGroup, "Let runs go on for longer, from where they are; done ones too",
            "  shaken extend 1f0c --measure 600s                 one job, by the beginning of its id\n"
            "  shaken extend s3 --measure '10 min'               all jobs of a sweep\n"
            "  shaken extend s3 --order-sem 0.005 --at-most 1h   until S is known well enough\n"
            "  shaken extend s3 --replicas 5                     five runs of each point, with those there are\n"
            "  shaken submit FILE -s time.measure=600s           does the same, and adds what is new"};
  }

  void declare(Arguments& arguments) override {
    arguments.list("ID", ids_, "Sweeps (id or name) and jobs", Names::kId, 1);
    arguments.option("--measure", measure_, "TIME", "Simulated time of the run after time.steady, in all");
    arguments.option("--order-sem", order_sem_, "ERROR", "Go on until the standard error of S is this at most");
    arguments.option("--at-most", at_most_, "TIME", "Simulated time at which the run ends in any case");
    arguments.option(
        "--replicas", replicas_, "N",
        "Runs of each point of a sweep, each with a seed of its own: as a sweep of the same name with those "
        "that are there and new ones");
    arguments.flag("--json", json_, "Print the daemon's answers as JSON");
  }

  ExitCode run(const Context& context) override {
    Json body = Json::object();
    if (!measure_.empty()) body["measure"] = measure_;
    if (!order_sem_.empty()) body["order_sem"] = order_sem_;
    if (!at_most_.empty()) body["at_most"] = at_most_;
    if (body.empty() && !replicas_) {
      throw Failure(
          ExitCode::kBadInput,
          "extend: say for how long, with --measure, --order-sem or --at-most, or how often, with --replicas");
    }
    if (!body.empty() && replicas_) {
      throw Failure(ExitCode::kBadInput,
                    "extend: --replicas makes a sweep of its own; let runs go on longer after that");
    }
    ApiClient session(context.root());
    Json answers = Json::array();
    bool all_go_on = true;
    for (const Target& target : find_targets(session, ids_)) {
      if (replicas_) {
        answers.push_back(add_replicas(session, target, context.console));
        continue;
      }
      Json answer = session.post(target.path + "/extend", body);
      const int n = answer.at("extended").get<int>();
      const Json refused = answer.value("refused", Json::array());
      all_go_on = all_go_on && refused.empty();
      answer["target"] = target.id();
      answers.push_back(std::move(answer));
      if (json_) continue;
      say_refused(refused, context.console);
      context.console.out << (n > 0 ? fmt::format("{}: {} extended\n", target.title(),
                                                  counted(static_cast<std::size_t>(n), "job"))
                                    : fmt::format("{}: as long as that already\n", target.title()));
    }
    if (json_) context.console.out << json_text(Json{{"targets", answers}});
    return all_go_on ? ExitCode::kOk : ExitCode::kFailed;
  }

 private:
  /// Jobs that stay as they are, by their reasons.
  static void say_refused(const Json& refused, Console& console) {
    std::map<std::string, std::vector<std::string>> by_reason;
    for (const Json& one : refused) by_reason[text_of(one, "reason")].push_back(short_id(text_of(one, "job")));
    for (const auto& [reason, jobs] : by_reason) {
      constexpr std::size_t kMostNamed = 5;
      std::string names =
          fmt::format("{}", fmt::join(jobs.begin(), jobs.begin() + std::min(jobs.size(), kMostNamed), ", "));
      if (jobs.size() > kMostNamed) names += fmt::format(" and {} more", jobs.size() - kMostNamed);
      console.err << fmt::format("not extended: {}: {}\n", names, printable(reason));
    }
  }

  Json add_replicas(ApiClient& session, const Target& target, Console& console) const {
    if (!target.is_sweep) {
      throw Failure(ExitCode::kBadInput, fmt::format("extend: {} is no sweep, so it has no replicas", target.title()));
    }
    const Json answer = session.post(target.path + "/replicas", {{"replicas", *replicas_}});
    const Json& sweep = answer.at("sweep");
    const Json& counts = answer.at("counts");
    if (!json_) {
      console.out << fmt::format("{}: with {} new of {} jobs it is sweep {}\n", target.title(), counts.value("new", 0),
                                 answer.at("jobs").size(), sweep.at("id").get<std::string>());
    }
    return {{"target", target.id()}, {"sweep", sweep}, {"counts", counts}};
  }

  std::vector<std::string> ids_;
  std::optional<int> replicas_;
  std::string measure_, order_sem_, at_most_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_extend() { return std::make_unique<Extend>(); }

}  // namespace shaken::client
