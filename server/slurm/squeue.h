#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shaken::server::slurm {

/// What squeue says of a task of a job array.
struct QueuedTask {
  enum class Stage { kWaiting, kWorking, kOver };
  std::string job;    ///< id of the array
  int task = 0;       ///< its number in the array
  std::string name;   ///< of the array
  std::string state;  ///< "RUNNING"
  std::string reason;
  Stage stage = Stage::kWaiting;
};

/// The command line that lists all tasks of this user, ended ones included as long as Slurm remembers them.
std::vector<std::string> squeue_command();
/// What that prints. Lines that are no tasks of arrays are passed over.
std::vector<QueuedTask> parse_squeue(std::string_view output);

/// The id in what `sbatch --parsable` prints, "123" or "123;cluster", among warnings; empty if there is none.
std::string parse_sbatch(std::string_view output);

}  // namespace shaken::server::slurm
