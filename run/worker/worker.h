#pragma once

#include <string>
#include <vector>

#include "base/failure.h"
#include "proto/bus.h"

namespace shaken::run {

/// What the command line of shaken-worker asks for.
struct WorkerOptions {
  std::string scene;
  std::vector<std::string> settings;
  std::string out;
  std::string job_id;
  std::string sweep_id;
  std::string label;
  std::string lcm_url = proto::default_url();
  bool no_lcm = false;
  int n_threads = 1;
  double checkpoint_every = 30;
  bool quiet = false;
  std::string probe;
  double probe_cpu = 1.0;
  std::string probe_from;
};

/// From now on SIGTERM, SIGINT and SIGHUP let the run end with a checkpoint.
void stop_on_signals();

/// Does the run that is asked for, or its probe, until it has ended or a signal has stopped it. Throws Failure, with
/// every problem of the scene.
ExitCode work(const WorkerOptions& asked);

}  // namespace shaken::run
