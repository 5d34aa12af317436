#include "tests/unit/server/server_support.h"

#include <fstream>
#include <sstream>
#include <thread>

namespace shaken::server {

bool eventually(const std::function<bool()>& condition, std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::filesystem::path write_fake_worker(const std::filesystem::path& folder) {
  const auto file = folder / "fake-worker";
  write_text(file, R"sh(#!/bin/sh
[ "$2" = --out ] && [ "$4" = --job-id ] && [ "$6" = --sweep-id ] && [ "$8" = --label ] || exit 3
dir=$3
exec 9>"$dir/lock"
flock -n 9 || { echo "lock is held" >&2; exit 4; }
id=$5
hold() { : >"$dir/up"; while :; do sleep 0.02 9>&-; done; }
summary() { echo "{\"n_rods\": 7, \"run_id\": \"$id\", \"exit\": {\"state\": \"done\", \"tick\": 1000000000}}" >"$dir/summary.json"; }
echo "$@"
case "${FAKE_WORKER:-$9}" in
  done) summary ;;
  room) echo "checkpoint.bin.tmp: No space left on device" >&2; exit 97 ;;
  empty) ;;
  fail) echo "the gap is closed" >&2; exit 1 ;;
  progress)
    cat >"$dir/progress.json" <<end
{"state": "failed", "message": "rod 3 is not finite", "pid": $$, "n_rods": 7, "fraction": 0.5, "sim_time_s": 1,
 "sim_time_total_s": 2, "sim_rate": 0.1, "eta_s": -1, "order": 0, "order_running_mean": 0, "max_overlap_mm": 0}
end
    exit 1 ;;
  bad) exit 2 ;;
  crash) kill -KILL $$ ;;
  "crash after checkpoint") : >"$dir/checkpoint.bin"; kill -KILL $$ ;;
  "stops at once") exit 99 ;;
  "stops further on")
    cat >"$dir/progress.json" <<end
{"state": "stopped", "message": "asked to stop", "pid": $$, "n_rods": 7, "fraction": 0.5, "sim_time_s": $(date +%s%N),
 "sim_time_total_s": 2, "sim_rate": 0.1, "eta_s": -1, "order": 0, "order_running_mean": 0, "max_overlap_mm": 0}
end
    exit 99 ;;
  run) trap 'exit 99' TERM; hold ;;
  late) trap 'summary; exit 0' TERM; hold ;;
  deaf) trap '' TERM; hold ;;
esac
)sh");
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  return file;
}

std::optional<int> begin(Queue& queue, const std::string& id) {
  const auto launched = queue.launch(id);
  return launched ? std::optional(launched->attempt) : std::nullopt;
}

NewJob new_job(char digit, const std::string& label) {
  return {std::string(16, digit), "{\"job\": \"" + std::string(1, digit) + "\"}\n", label, "{}", 1, std::nullopt};
}

}  // namespace shaken::server
