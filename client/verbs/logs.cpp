#include <fmt/format.h>

#include "base/interrupt.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Logs : public Verb {
 public:
  VerbInfo info() const override {
    return {"logs", kControlGroup, "What a job's worker has written",
            "  shaken logs 1f0c              the log of one job\n"
            "  shaken logs 1f0c -f           go on until the job ends",
            "0 done, with -f only if the job is done; 1 failed, 2 bad input, 3 no daemon"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("JOB", id_, "A job, by the beginning of its id", Names::kJob);
    arguments.flag("-f,--follow", follow_, "Wait for more until the job ends");
  }

  ExitCode run(const Context& context) override {
    ApiClient session(context.root());
    const std::string id = find_job(session, id_).at("id").get<std::string>();
    const InterruptGuard guard;
    std::string state;
    for (std::int64_t offset = 0;;) {
      const Json answer = session.get(fmt::format("/v1/jobs/{}/log?offset={}", url_encoded(id), offset));
      const std::string text = answer.at("text").get<std::string>();
      context.console.out << printable(text, Lines::kMany) << std::flush;
      offset = answer.at("offset").get<std::int64_t>();
      state = answer.at("state").get<std::string>();
      if (guard.interrupted()) return ExitCode::kInterrupted;
      if (!context.console.out.good()) return ExitCode::kOk;
      // A long log comes in pieces, also where it is not followed.
      if (!text.empty()) continue;
      if (!follow_) return ExitCode::kOk;
      if (has_ended(answer)) break;
      guard.sleep_for(std::chrono::milliseconds(500));
    }
    context.console.err << fmt::format("job {} is {}\n", short_id(id), state);
    return state == "done" ? ExitCode::kOk : ExitCode::kFailed;
  }

 private:
  std::string id_;
  bool follow_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_logs() { return std::make_unique<Logs>(); }

}  // namespace shaken::client
