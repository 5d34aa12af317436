#include "run/loop/movie_process.h"

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/files.h"
#include "base/process.h"
#include "run/files/directory.h"

namespace shaken::run {
namespace {

/// How `child` ended; ends it first if `stop` becomes true. Calls `look` every half second.
ProcessEnd wait_for(pid_t child, const std::atomic<bool>& stop, const std::function<void()>& look) {
  constexpr std::chrono::milliseconds kPause{20};
  constexpr int kPausesBetweenLooks = 25;
  bool asked = false;
  for (int pauses = 0;; ++pauses) {
    if (const auto end = poll_child(child)) return *end;
    if (stop && !asked) {
      kill(child, SIGTERM);
      asked = true;
    }
    if (pauses % kPausesBetweenLooks == kPausesBetweenLooks - 1) look();
    std::this_thread::sleep_for(kPause);
  }
}

/// Tells what shaken-render has written of how far it is; nothing if it has not, or not to be read.
void tell(const std::filesystem::path& file, const OnDrawn& on_drawn) {
  const Result<std::string> text = read_file(file);
  if (!text || !on_drawn) return;
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  if (!json.is_object()) return;
  const double drawn = json.value("frames_drawn", 0.0), frames = json.value("frames", 0.0),
               seconds = json.value("seconds", 0.0);
  if (frames > 0 && drawn > 0) on_drawn(drawn / frames, seconds / drawn * (frames - drawn));
}

}  // namespace

Result<void> render_movie(const std::filesystem::path& directory, const std::atomic<bool>& stop,
                          const std::string& label, const OnDrawn& on_drawn) {
  const std::string program = sibling_program("shaken-render").string();
  const std::filesystem::path so_far = directory / "drawing.json";
  std::vector<std::string> command{program, "movie", directory.string(), "--progress", so_far.string()};
  if (!label.empty()) command.insert(command.end(), {"--label=" + label});
  const pid_t child = SHAKEN_TRY(start_child({.command = command, .ends_with_us = true}));
  const ProcessEnd end = wait_for(child, stop, [&] { tell(so_far, on_drawn); });
  if (end.is_success()) tell(so_far, on_drawn);
  std::error_code ignored;
  std::filesystem::remove(so_far, ignored);
  if (!end.is_success()) remove_unfinished(RunDirectory{directory}.movie());  // it may have been killed
  if (stop) return Error{"stopped while drawing"};
  if (!end.is_success()) return Error{program + " " + end.text()};
  return {};
}

}  // namespace shaken::run
