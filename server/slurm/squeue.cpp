#include "server/slurm/squeue.h"

#include <unistd.h>

#include <algorithm>
#include <array>

#include "base/text.h"

namespace shaken::server::slurm {
namespace {

constexpr std::array<std::string_view, 10> kOver{"BOOT_FAIL", "CANCELLED",     "COMPLETED", "DEADLINE", "FAILED",
                                                 "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "REVOKED",  "TIMEOUT"};
constexpr std::array<std::string_view, 7> kWorking{"RUNNING",   "COMPLETING", "SUSPENDED", "STOPPED",
                                                   "SIGNALING", "STAGE_OUT",  "RESIZING"};

template <class Words>
bool is_among(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  parts.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), at)) + 1);
  for (std::size_t end = text.find(at); end != text.npos; end = text.find(at)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

bool is_number(std::string_view word) { return !word.empty() && word.find_first_not_of("0123456789") == word.npos; }

}  // namespace

std::vector<std::string> squeue_command() {
  return {"squeue",
          "--noheader",
          "--array",
          "--states=all",
          "--user=" + std::to_string(geteuid()),
          "--format=%F|%K|%T|%j|%r"};
}

std::vector<QueuedTask> parse_squeue(std::string_view output) {
  std::vector<QueuedTask> tasks;
  for (const std::string_view line : split(output, '\n')) {
    const auto parts = split(line, '|');
    if (parts.size() < 5 || !is_number(parts[0]) || !is_number(parts[1])) continue;
    const auto number = number_in<int>(parts[1]);
    if (!number) continue;
    QueuedTask task{std::string(parts[0]), *number, std::string(parts[3]), std::string(parts[2]),
                    std::string(parts[4])};
    if (is_among(kOver, task.state)) task.stage = QueuedTask::Stage::kOver;
    if (is_among(kWorking, task.state)) task.stage = QueuedTask::Stage::kWorking;
    tasks.push_back(std::move(task));
  }
  return tasks;
}

std::string parse_sbatch(std::string_view output) {
  for (const std::string_view line : split(output, '\n')) {
    const std::string_view id = line.substr(0, line.find(';'));
    if (is_number(id)) return std::string(id);
  }
  return {};
}

}  // namespace shaken::server::slurm
