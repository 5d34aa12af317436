#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/http/http_server.h"
#include "base/keys/problem.h"
#include "server/answers.h"
#include "server/daemon_info.h"
#include "server/queue/queue.h"

namespace shaken::server {

struct Submission;

/// The control API of docs/protocol.md: from a request to an answer, by one table of routes. Writes only to the
/// queue; may be called from many threads at once.
class Api {
 public:
  Api(Queue& queue, DaemonInfo info) : queue_(queue), info_(std::move(info)) {}

  /// Never throws: whatever goes wrong is an answer of 4xx or 5xx with {"error": "..."}.
  http::Reply handle(const http::Request& request) const;

 private:
  struct Call;
  struct Answer;
  struct Route;
  static std::span<const Route> routes();
  Answer dispatch(const http::Request& request) const;

  Answer status(const Call& call) const;
  Answer submit(const Call& call) const;
  Answer add_replicas(const Call& call) const;
  Answer list_sweeps(const Call& call) const;
  Answer show_sweep(const Call& call) const;
  Answer list_jobs(const Call& call) const;
  Answer show_job(const Call& call) const;
  Answer show_log(const Call& call) const;
  Answer show_history(const Call& call) const;
  /// Of "/v1/jobs/ID/ACTION" and "/v1/sweeps/ID/ACTION".
  Answer control(const Call& call) const;
  Answer extend(const Call& call) const;
  Answer results(const Call& call) const;
  Answer clean(const Call& call) const;

  /// What a submission would put into the queue.
  static Answer checked(const Submission& submission);
  /// Puts jobs into the queue and tells what became of them.
  Answer submitted(const std::string& name, int priority, std::vector<NewJob> jobs, const Terms& terms) const;
  static Answer problems_answer(std::span<const keys::Problem> found);
  /// Whether the path is that of a sweep, and not of a job.
  static bool in_sweep(const Call& call);

  Sweep find_sweep(const std::string& word) const;
  Job find_job(const std::string& prefix) const;
  /// A sweep by its id or name, or else a job.
  Target find_target(const std::string& word) const;
  std::vector<Job> find_jobs(const Call& call) const;
  /// A parameter of the path that counts something; 0 if it is not there. `meaning` is for the refusal.
  static std::int64_t count_in(const Call& call, const std::string& parameter, const std::string& meaning);
  Line line() const;
  Json report(const Sweep& sweep) const;
  Json report(const Sweep& sweep, const Line& line) const;
  Json report(std::span<const Job> jobs) const;

  Queue& queue_;
  DaemonInfo info_;
};

}  // namespace shaken::server
