#include <fmt/format.h>

#include <stdexcept>

#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

/// A verb that changes jobs in the queue.
struct Action {
  const char* name;  ///< of the verb and of the route, /v1/jobs/ID/NAME
  const char* summary;
  const char* examples;
  const char* past;  ///< "cancelled", also the key of the answer
};

constexpr Action kCancel{
    "cancel", "Cancel jobs that have not ended; what they have measured stays",
    "  shaken cancel 1f0c            one job, by the beginning of its id\n"
    "  shaken cancel s3 s4           all jobs of two sweeps\n"
    "  shaken submit FILE            queues cancelled points again; they go on from their checkpoint",
    "cancelled"};
constexpr Action kHold{"hold", "Keep jobs from running until they are resumed; running ones stop at a checkpoint",
                       "  shaken hold s3                all jobs of a sweep that have not ended\n"
                       "  shaken resume s3              they go on from their checkpoints",
                       "held"};
constexpr Action kResume{"resume", "Let held jobs run again, from their checkpoints",
                         "  shaken resume 1f0c            one job, by the beginning of its id\n"
                         "  shaken resume s3              all held jobs of a sweep; lifts the stop rule that held them",
                         "resumed"};
constexpr Action kRetry{"retry", "Queue jobs again that came to nothing or are held; they go on from their checkpoints",
                        "  shaken status s3 --failed     what failed, and why\n"
                        "  shaken retry s3               tries all that failed or was cancelled again",
                        "retried"};
constexpr Action kPriority{"priority", "Say which jobs go first: those with the larger number",
                           "  shaken priority 10 s3         all jobs of a sweep that have not ended\n"
                           "  shaken priority -- -1 1f0c    one job, after all others (0 is the default)",
                           "changed"};

class Control : public Verb {
 public:
  explicit Control(const Action& action) : action_(action) {}

  VerbInfo info() const override { return {action_.name, kControlGroup, action_.summary, action_.examples}; }

  void declare(Arguments& arguments) override {
    if (needs_number()) arguments.required("NUMBER", number_, "From -1000000 to 1000000", Names::kAnything);
    arguments.list("ID", ids_, "Sweeps (id or name) and jobs", Names::kId, 1);
    arguments.flag("--json", json_, "Print the daemon's answers as JSON");
  }

  ExitCode run(const Context& context) override {
    Json body = Json::object();
    if (needs_number()) body["priority"] = priority();
    ApiClient session(context.root());
    Json answers = Json::array();
    for (const Target& target : find_targets(session, ids_)) {
      const int n = session.post(target.path + "/" + action_.name, body).at(action_.past).get<int>();
      answers.push_back({{"target", target.id()}, {action_.past, n}});
      if (json_) continue;
      context.console.out << (n > 0 ? fmt::format("{}: {} {}\n", target.title(),
                                                  counted(static_cast<std::size_t>(n), "job"), action_.past)
                                    : fmt::format("{}: nothing to be {}\n", target.title(), action_.past));
    }
    if (json_) context.console.out << json_text(Json{{"targets", answers}});
    return ExitCode::kOk;
  }

 private:
  bool needs_number() const { return &action_ == &kPriority; }
  int priority() const {
    std::size_t end = 0;
    try {
      const int number = std::stoi(number_, &end);
      if (end == number_.size()) return number;
    } catch (const std::logic_error&) {
    }
    throw Failure(ExitCode::kBadInput, fmt::format("priority: '{}' is no whole number", number_));
  }

  const Action& action_;
  std::string number_;
  std::vector<std::string> ids_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_cancel() { return std::make_unique<Control>(kCancel); }
std::unique_ptr<Verb> make_hold() { return std::make_unique<Control>(kHold); }
std::unique_ptr<Verb> make_resume() { return std::make_unique<Control>(kResume); }
std::unique_ptr<Verb> make_retry() { return std::make_unique<Control>(kRetry); }
std::unique_ptr<Verb> make_priority() { return std::make_unique<Control>(kPriority); }

}  // namespace shaken::client
