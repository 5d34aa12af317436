#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/executor.h"
#include "server/slurm/array_task.h"
#include "server/slurm/batch.h"

namespace shaken::server::slurm {

/// A batch on its way: open, while it takes workers; closed, once it is written; unsure, while sbatch runs or after it
/// has failed; then out, or refused. Its workers are known by their place in it, of which each task has as many.
class SentBatch {
 public:
  enum class Stage {
    kOpen,     ///< takes further workers
    kClosed,   ///< is to be handed over
    kUnsure,   ///< may have been handed over, or not: the next answer of squeue tells
    kOut,      ///< Slurm has it
    kRefused,  ///< Slurm does not have it, and will not
  };

  /// A new one. `settings`: see Launch.
  SentBatch(std::filesystem::path folder, std::string settings, int runs_per_task);
  /// One that a former daemon has handed over, of which no worker is anybody's until adopt(); none if it was not
  /// written.
  static std::optional<SentBatch> written(const std::filesystem::path& folder);

  // --- its workers ---
  /// Whether one that asks for this can go with it, in `most_tasks` tasks.
  bool fits(const std::string& settings, std::size_t most_tasks) const;
  /// Returns the place of the new one.
  int add(const Launch& launch);
  /// False if there is no such place.
  bool adopt(int run);
  /// What is known of a worker. `report_delay`: for so long after the end of a task its last words may not be seen yet.
  WorkerReport state_of(int run, std::chrono::milliseconds report_delay) const;
  bool is_stop_asked(int run) const { return runs_[static_cast<std::size_t>(run)].stop_asked; }
  void set_collected(int run) { runs_[static_cast<std::size_t>(run)].collected = true; }
  void stop(int run);
  void kill(int run) { task_of(run).cancel(false); }
  std::string job_of(int run) const;  ///< "7_0", as Slurm calls its task

  // --- on its way ---
  Stage stage() const { return stage_; }
  bool may_be_out() const { return stage_ == Stage::kOut || stage_ == Stage::kUnsure; }
  /// Closes it, and writes its files, unless it has grown since the last call. `task`: the program of its tasks.
  void close(const std::filesystem::path& worker, const std::filesystem::path& task);
  void set_unsure(const std::string& why);
  void set_out(const std::string& job);
  void set_refused() { stage_ = Stage::kRefused; }
  /// Takes an answer of squeue, that is its tasks in it. One that Slurm does not know has not come there.
  void update_tasks(const std::vector<const QueuedTask*>& listed);
  /// Reads what tasks have reported that may have begun, all of them if Slurm does not say.
  void read_reports(bool of_all, std::chrono::milliseconds report_delay);
  /// Whether nothing more is to be expected of it.
  bool is_finished() const;

  // --- its tasks ---
  /// Writes down which workers are to stop, where that is not written yet.
  Result<void> write_stops();
  bool has_unwritten_stops() const { return !unwritten_stops_.empty(); }
  std::vector<ArrayTask>& tasks() { return tasks_; }
  const std::vector<ArrayTask>& tasks() const { return tasks_; }
  std::size_t n_runs() const { return runs_.size(); }
  /// For further workers, in tasks that are there.
  int n_free_places() const { return static_cast<int>(tasks_.size()) * runs_per_task_ - static_cast<int>(n_runs()); }
  const BatchFolder& folder() const { return folder_; }
  const std::string& settings() const { return settings_; }
  const std::string& job() const { return job_; }

 private:
  struct Run {
    Launch launch{};  ///< until the batch is written
    bool begun = false;
    bool stop_asked = false;
    bool collected = false;  ///< its end, by whoever asked for it
    std::optional<WorkerEnd> end{};
  };
  int number_of(int run) const { return run / runs_per_task_; }
  ArrayTask& task_of(int run) { return tasks_[static_cast<std::size_t>(number_of(run))]; }
  const ArrayTask& task_of(int run) const { return tasks_[static_cast<std::size_t>(number_of(run))]; }
  /// The worker at a place of a task; null where there is none.
  Run* run_at(int task, int place);
  void read_report_of(int task);

  BatchFolder folder_;
  std::string settings_;
  int runs_per_task_;
  Stage stage_ = Stage::kOpen;
  bool grown_ = false;    ///< since the last close()
  bool adopted_ = false;  ///< a former daemon has handed it over
  std::string job_;       ///< Slurm's id of the array
  std::string error_;     ///< why it is unsure or refused
  std::vector<Run> runs_;
  std::vector<ArrayTask> tasks_;
  std::set<int> unwritten_stops_;  ///< tasks
};

}  // namespace shaken::server::slurm
