// SPDX-License-Identifier: MIT
#include "bench/steady_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "base/failure.h"
#include "base/files.h"
#include "base/progress_line.h"
#include "bench/picture.h"
#include "scene/canonical.h"

namespace shaken::bench {
namespace {

/// Of one cached state: a line of text that names its owner and the checkpoint's state hash, then the checkpoint.
std::string header_of(const std::string& key, std::uint64_t state_hash) {
  return fmt::format("shaken steady state {} {:016x}\n", key, state_hash);
}

std::span<const std::byte> as_bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// The checkpoint in `file`, if it is whole and of this case.
std::optional<std::vector<std::byte>> read_cached(const Case& wanted, const std::string& key,
                                                  const std::filesystem::path& file) {
  const Result<std::string> content = read_file(file);
  if (!content) return std::nullopt;
  const std::size_t line = content->find('\n');
  if (line == std::string::npos) return std::nullopt;
  const auto bytes = as_bytes_of(std::string_view(*content).substr(line + 1));
  const Result<Simulation> simulation = Simulation::resume(wanted.system(), bytes);
  if (!simulation || simulation->tick() != wanted.warm_up_ticks()) return std::nullopt;
  if (content->substr(0, line + 1) != header_of(key, simulation->state_hash())) return std::nullopt;
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

Simulation simulate(const Case& wanted) {
  Result<Simulation> started = Simulation::start(wanted.system());
  if (!started) throw Failure(ExitCode::kBadInput, wanted.label() + ": " + started.error().message);
  Simulation simulation = std::move(started).value();
  ProgressLine progress(fmt::format("steady state of {} (N = {}), {:.10g} s of it", wanted.label(),
                                    wanted.system().n_rods, wanted.warm_up));
  const Tick end = wanted.warm_up_ticks();
  // short enough for progress to be shown, long enough to cost nothing
  const Tick stride = std::max<Tick>(1, 200'000 / wanted.system().n_rods);
  while (simulation.tick() < end) {
    advance(simulation, std::min(stride, end - simulation.tick()));
    progress.show(static_cast<double>(simulation.tick()) / static_cast<double>(end));
  }
  return simulation;
}

}  // namespace

std::filesystem::path default_cache() {
  if (const char* base = std::getenv("XDG_CACHE_HOME"); base != nullptr && *base != '\0') {
    return std::filesystem::path(base) / "shaken" / "bench";
  }
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home != nullptr ? home : ".") / ".cache" / "shaken" / "bench";
}

SteadyState steady_state(const Case& wanted, const std::filesystem::path& cache) {
  const std::string key = scene::run_id(wanted.plan);
  const std::filesystem::path file = cache / (key + ".state");
  if (auto cached = read_cached(wanted, key, file)) return {std::move(*cached), true};

  make_folder(cache);
  const Simulation simulation = simulate(wanted);
  SteadyState made{simulation.checkpoint(), false};
  std::string content = header_of(key, simulation.state_hash());
  content.append(reinterpret_cast<const char*>(made.checkpoint.data()), made.checkpoint.size());
  write_text(file, content);
  return made;
}

Simulation resumed(const Case& of, const SteadyState& state, Engine engine) {
  Scene scene = of.system();
  scene.engine = engine;
  Result<Simulation> simulation = Simulation::resume(scene, state.checkpoint);
  if (!simulation) throw Failure(ExitCode::kFailed, of.label() + ": " + simulation.error().message);
  return std::move(simulation).value();
}

void advance(Simulation& simulation, Tick ticks) {
  if (const auto trouble = simulation.advance_to(simulation.tick() + ticks)) {
    throw Failure(ExitCode::kFailed, fmt::format("numerical trouble at tick {}: {}", trouble->tick, trouble->what));
  }
}

}  // namespace shaken::bench
