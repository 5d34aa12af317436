#pragma once

#include <string>
#include <string_view>

#include "base/core/result.h"
#include "server/queue/job.h"

namespace shaken::server {

/// When a sweep has failed too often to go on: "failed>10%", of its jobs that have ended by themselves (done, failed or
/// timed out), or "failed>3", a number of jobs.
class StopRule {
 public:
  /// Blanks do not matter. The error says what a rule looks like.
  static Result<StopRule> parse(std::string_view text);

  /// As it is written without blanks; parse() of it gives the rule again.
  std::string text() const;
  /// Whether a sweep with these jobs is to stop. A percentage is judged once five jobs have ended.
  bool is_broken(const JobCounts& counts) const;
  /// "failed>10%: 2 of 7 jobs that ended have failed"
  std::string reason(const JobCounts& counts) const;

 private:
  StopRule(double most, bool is_percentage) : most_(most), is_percentage_(is_percentage) {}
  double most_;
  bool is_percentage_;
};

}  // namespace shaken::server
