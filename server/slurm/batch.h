// A batch: workers that go to Slurm together, as one job array. Daemon and tasks tell each other of it through files in
// its folder, which both must see.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "base/files.h"
#include "server/executor.h"

namespace shaken::server::slurm {

/// What the tasks of a batch are to do.
struct Batch {
  std::filesystem::path worker;            ///< the program
  std::vector<std::vector<Launch>> tasks;  ///< the workers of each, which it starts one after the other
};

/// What a task tells of itself; by the places of its workers in it.
struct TaskReport {
  std::string slurm_job;  ///< the id that Slurm has for this task alone
  std::string host;
  int restarts = 0;               ///< how often Slurm has put it back and started it again
  std::set<int> begun;            ///< workers that were started, ever
  std::map<int, WorkerEnd> ends;  ///< final: a task that is started again leaves these out
};

/// Where the files of a batch are.
struct BatchFolder {
  std::filesystem::path root;

  std::filesystem::path plan() const { return root / "batch.json"; }
  std::filesystem::path script() const { return root / "job.sh"; }
  /// The id that Slurm has for the batch; there once that is known.
  std::filesystem::path job() const { return root / "job"; }
  std::filesystem::path report(int task) const { return root / (std::to_string(task) + ".json"); }
  /// Places of workers that are to stop, or not to begin.
  std::filesystem::path stop(int task) const { return root / (std::to_string(task) + ".stop"); }
};

Result<void> write_batch(const BatchFolder& folder, const Batch& batch);
Result<Batch> read_batch(const BatchFolder& folder);
Result<void> write_report(const std::filesystem::path& file, const TaskReport& report);
Result<TaskReport> read_report(const std::filesystem::path& file);
/// A reader sees the old file or the new.
Result<void> write_stop(const std::filesystem::path& file, const std::set<int>& places, Lasting lasting);
/// Nobody where there is no such file.
std::set<int> read_stop(const std::filesystem::path& file);

}  // namespace shaken::server::slurm
