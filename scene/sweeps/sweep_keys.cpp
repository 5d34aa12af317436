#include "scene/sweeps/sweep_keys.h"

namespace shaken::scene {

namespace {

using Row = keys::Key<Sweep>;

template <auto member>
inline constexpr auto slurm = at<&Sweep::slurm, member>;

/// A name as Slurm's partitions and accounts have them.
Row name_of(const std::string& key, auto access, const std::string& expected, const std::string& doc) {
  return plain({.path = "slurm." + key,
                .form = Form::kText,
                .pattern = "[A-Za-z0-9_.,+@][A-Za-z0-9_.,+@-]*",
                .longest = 200,
                .expected = expected,
                .fallback_note = "that of Slurm",
                .doc = doc},
               access);
}

std::vector<Row> rows_of_sweeps() {
  return {
      derived(text("name", at<&Sweep::name>, "Name of the sweep."), "that of the file"),
      plain({.path = "executor",
             .form = Form::kName,
             .names = {"local", "slurm"},
             .fallback_note = "where those of the daemon do",
             .doc = "Where the runs run."},
            at<&Sweep::executor>),
      name_of("partition", slurm<&SlurmSettings::partition>, "the name of a partition, such as \"short\"",
              "Partition, or several with commas."),
      name_of("account", slurm<&SlurmSettings::account>, "the name of an account", "Account that is charged."),
      // Slurm counts in minutes
      derived(
          quantity("slurm.time", slurm<&SlurmSettings::time>, Dimension::kTime, 60, 31.6e6,
                   "Wall time of a task, after which Slurm ends it. Its runs write a checkpoint shortly before, and "
                   "go on in another task. Slurm counts whole minutes; what is left over is rounded up."),
          "that of the partition"),
      plain({.path = "slurm.memory",
             .form = Form::kText,
             .pattern = "[1-9][0-9]{0,8}[KMGT]",
             .longest = 10,
             .expected = "a whole number with K, M, G or T, such as \"4G\"",
             .fallback_note = "that of the partition",
             .doc = "Memory of a task."},
            slurm<&SlurmSettings::memory>),
      derived(whole("slurm.runs_per_task", slurm<&SlurmSettings::runs_per_task>, 1, 10'000,
                    "Runs that a task does, one after the other: some minutes of work for each task are good."),
              "that of the daemon (`--runs-per-task`)"),
      plain({.path = "slurm.options",
             .form = Form::kTexts,
             .pattern = "--[a-z-]{2,}(=.*)?",
             .longest = 1000,
             .most = 50,
             .problem = slurm_option_problem,
             .expected = "a text such as \"--constraint=avx2\"",
             .doc = "Further options of sbatch, each a text that begins with `--`, with its value behind `=`."},
            slurm<&SlurmSettings::options>),
      {{.path = "scene", .form = Form::kElsewhere}},
      {{.path = "sweep", .form = Form::kElsewhere}},
  };
}

}  // namespace

const keys::Table<Sweep>& sweep_keys() {
  static const keys::Table<Sweep> table(rows_of_sweeps());
  return table;
}

}  // namespace shaken::scene
