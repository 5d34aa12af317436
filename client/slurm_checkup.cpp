#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "base/process.h"
#include "base/slurm_conf.h"
#include "base/text.h"
#include "client/checkup.h"
#include "run/files/version.h"

namespace shaken::client {
namespace {

using Level = CheckResult::Level;

/// A Slurm that does not answer keeps its programs waiting for long.
const std::string kSlurmPatience = "20";
// as timeout(1) has them
constexpr int kTimeIsOver = 124;
constexpr int kNotFound = 127;

Captured within_patience(std::vector<std::string> command) {
  command.insert(command.begin(), {std::string("timeout"), kSlurmPatience});
  return run_captured(command);
}

std::string first_words(const Captured& result) {
  constexpr std::size_t kMost = 200;
  return printable(fitted(result.output.substr(0, result.output.find('\n')), kMost));
}

/// Why a program gave up.
std::string last_words(const Captured& result) {
  std::string text = result.output;
  text.erase(text.find_last_not_of('\n') + 1);
  if (text.empty()) return fmt::format("exit code {}", result.exit_code);
  const std::size_t line = text.rfind('\n');
  return first_words({result.exit_code, line == std::string::npos ? text : text.substr(line + 1)});
}

CheckResult check_programs() {
  const std::string set_conf =
      "export SLURM_CONF=FILE, the slurm.conf of the cluster, here and where the daemon is started";
  if (const auto file = missing_slurm_conf()) {  // the programs would look for it for a minute
    return {Level::kFail, "slurm", fmt::format("SLURM_CONF names {}, and there is no such file", printable(*file)),
            set_conf};
  }
  std::string missing;
  std::string version;
  for (const char* name : {"sbatch", "squeue", "scancel"}) {
    const Captured result = within_patience({name, "--version"});
    if (result.exit_code == kNotFound) {
      missing += (missing.empty() ? "" : ", ") + std::string(name);
    } else if (result.exit_code != 0) {
      return {Level::kFail, "slurm",
              fmt::format("{} finds no cluster: {} ({})", name, last_words(result), printable(slurm_conf_text())),
              set_conf};
    } else {
      version = first_words(result);
    }
  }
  if (missing.empty()) return {Level::kOk, "slurm", version, ""};
  return {Level::kFail, "slurm", "not found: " + missing,
          "run the daemon where Slurm's programs are, on a login node; Debian: sudo apt install slurm-client"};
}

CheckResult check_controller() {
  const Captured result = within_patience({"sinfo", "--noheader", "--format=%P %a, %D nodes %t"});
  if (result.exit_code == 0) return {Level::kOk, "controller", first_words(result), ""};
  return {Level::kFail, "controller",
          fmt::format("{} ({})",
                      result.exit_code == kTimeIsOver
                          ? fmt::format("slurmctld has not answered within {} s", kSlurmPatience)
                          : first_words(result),
                      printable(slurm_conf_text())),
          "scontrol ping; the daemon waits for it, and loses nothing"};
}

CheckResult check_arrays() {
  constexpr int kNeeded = 500;  // server/slurm makes no larger ones
  constexpr std::string_view kKey = "MaxArraySize";
  const Captured result = within_patience({"scontrol", "show", "config"});
  const std::size_t at = result.output.find(kKey);
  if (result.exit_code != 0 || at == std::string::npos) return {Level::kWarn, "arrays", "their limit is not known", ""};
  const std::size_t digits = result.output.find_first_of("0123456789", at);
  int size = 0;
  if (digits != std::string::npos) {
    std::from_chars(result.output.data() + digits, result.output.data() + result.output.size(), size);
  }
  const std::string message = fmt::format("MaxArraySize is {}", size);
  if (size > kNeeded) return {Level::kOk, "arrays", message, ""};
  return {Level::kWarn, "arrays", message,
          fmt::format("keep below it: shakend --max-pending {}", std::max(1, size - 1))};
}

/// Whether a node sees the files that its tasks need; asks one that is free.
CheckResult check_shared(const std::filesystem::path& root) {
  if (std::error_code error; !std::filesystem::exists(root, error)) {
    return {Level::kFail, "shared root",
            fmt::format("{} does not exist yet, so no node can write there", root.string()),
            fmt::format("mkdir -p {}, in a folder that all nodes share, and ask again", root.string())};
  }
  const auto task = sibling_program("shaken-task"), worker = sibling_program("shaken-worker");
  const Captured result =
      run_captured({"timeout", "60", "srun", "--immediate=15", "--ntasks=1", "--quiet", "--chdir=/", "test", "-w",
                    root.string(), "-a", "-x", task.string(), "-a", "-x", worker.string()});
  if (result.exit_code == 0) {
    return {Level::kOk, "shared root", fmt::format("a node can write {} and run {}", root.string(), worker.string()),
            ""};
  }
  if (result.exit_code == 1 && result.output.find("allocat") == std::string::npos) {
    return {Level::kFail, "shared root",
            fmt::format("a node cannot write {}, or has no {} and shaken-task", root.string(), worker.string()),
            "put both on a file system that all nodes share: shakend --root DIR, cmake --install --prefix DIR"};
  }
  return {Level::kWarn, "shared root", "not tried, no node was free: " + first_words(result),
          "srun test -w ROOT says whether nodes see it"};
}

}  // namespace

std::vector<CheckResult> slurm_checkup(const std::filesystem::path& root) {
  forget_slurm_filters();  // as the daemon does
  std::vector<CheckResult> findings{check_programs()};
  if (findings.back().level == Level::kFail) return findings;
  findings.push_back(check_controller());
  if (findings.back().level == Level::kFail) return findings;
  findings.push_back(check_arrays());
  findings.push_back(check_shared(root));
  return findings;
}

}  // namespace shaken::client
