#include "client/checkup.h"

#include <fmt/format.h>
#include <unistd.h>

#include "base/failure.h"
#include "base/plots_by_python.h"
#include "base/process.h"
#include "base/processor.h"
#include "base/text.h"
#include "client/live/api_client.h"
#include "client/live/target.h"
#include "proto/bus.h"
#include "run/files/version.h"

namespace shaken::client {
namespace {

namespace fs = std::filesystem;
using Level = CheckResult::Level;

/// The first line of `text`.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

CheckResult check_sibling(const std::string& name, Level if_missing, const std::string& needed_for) {
  const fs::path program = sibling_program(name);
  const Captured result = run_captured({program.string(), "--version"});
  const std::string version = first_line(result.output);
  if (result.exit_code != 0) {
    const bool is_there = fs::exists(program);
    return {if_missing, name,
            is_there ? fmt::format("{} does not work (exit code {}): {}", program.string(), result.exit_code, version)
                     : fmt::format("not found beside this program, in {}", program.parent_path().string()),
            fmt::format("build or install it; it is needed {}", needed_for)};
  }
  if (version.find(run::version()) == std::string::npos) {
    return {Level::kWarn, name, fmt::format("{}, but this client is {}", version, run::version()),
            "build all programs from one source"};
  }
  return {Level::kOk, name, version, ""};
}

CheckResult check_daemon(const fs::path& root) {
  try {
    const Json status = ApiClient(root).get("/v1/status");
    const std::string version = text_of(status, "version");
    const std::string message = fmt::format("{} at {}, pid {}, {} slots", version, (root / "shakend.sock").string(),
                                            status.value("pid", 0), status.value("slots", 0));
    if (version != run::version()) {
      return {Level::kWarn, "daemon", message, fmt::format("this client is {}: restart the daemon", run::version())};
    }
    const Json& lcm = status.at("lcm");
    if (!lcm.value("ok", false)) {
      return {Level::kWarn, "daemon", message + "; no live state: " + text_of(lcm, "message"), "see lcm below"};
    }
    return {Level::kOk, "daemon", message, ""};
  } catch (const Failure& failure) {
    // `shaken run` works without one.
    return {Level::kWarn, "daemon", failure.what(), fmt::format("shakend --root {} &", shell_word(root.string()))};
  } catch (const Json::exception& error) {
    return {Level::kFail, "daemon", error.what(), "restart the daemon"};
  }
}

CheckResult check_lcm() {
  const std::string url = proto::default_url();
  const Result<std::unique_ptr<proto::Bus>> bus = proto::Bus::open(url);
  if (bus) return {Level::kOk, "lcm", url, ""};
  return {Level::kWarn, "lcm", fmt::format("{}: {}", url, bus.error().message), "sudo ip route add 224.0.0.0/4 dev lo"};
}

CheckResult check_plots() {
  try {
    return {Level::kOk, "plots", plots_by_python({"check"}).front(), ""};
  } catch (const Failure& failure) {
    return {Level::kWarn, "plots", first_line(failure.what()),
            chosen_python().empty() ? "sudo apt install --reinstall python3-matplotlib python3-numpy python3-h5py"
                                    : "unset SHAKEN_PYTHON, or install matplotlib, numpy and h5py for it"};
  }
}

CheckResult check_films() {
  const Captured said = run_captured({"ffmpeg", "-version"});
  if (said.exit_code == 0) return {Level::kOk, "films", first_line(said.output), ""};
  return {Level::kWarn, "films", first_line(said.output), "sudo apt install ffmpeg"};
}

CheckResult check_disk(fs::path folder) {
  static constexpr double kGigabyte = 1e9;
  std::error_code error;
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  const fs::space_info space = fs::space(folder, error);
  if (error) return {Level::kFail, "disk", fmt::format("{}: {}", folder.string(), error.message()), ""};
  const double free = static_cast<double>(space.available) / kGigabyte;
  const std::string message = fmt::format("{:.1f} GB free at {}", free, folder.string());
  if (access(folder.c_str(), W_OK) != 0) {
    return {Level::kFail, "disk", folder.string() + " cannot be written to", "choose another --root"};
  }
  if (free < 0.1) return {Level::kFail, "disk", message, "free some space, or choose another --root"};
  if (free < 2) return {Level::kWarn, "disk", message, "long trajectories take gigabytes"};
  return {Level::kOk, "disk", message, ""};
}

CheckResult check_cores() {
  return {Level::kOk, "cores", fmt::format("{}: as many runs at once", allowed_cores()), ""};
}

}  // namespace

std::vector<CheckResult> checkup(const fs::path& root) {
  return {{Level::kOk, "shaken", fmt::format("{}, {}", run::version(), run::compiler()), ""},
          check_sibling("shakend", Level::kWarn, "for sweeps"),
          check_sibling("shaken-worker", Level::kFail, "for every run"),
          check_sibling("shaken-web", Level::kWarn, "for the page in a browser"),
          check_sibling("shaken-render", Level::kWarn, "for pictures and movies (OSMesa)"),
          check_sibling("shaken-bench", Level::kWarn, "for `shaken bench`"),
          check_daemon(root),
          check_lcm(),
          check_plots(),
          check_films(),
          check_disk(root),
          check_cores()};
}

}  // namespace shaken::client
