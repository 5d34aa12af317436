// SPDX-License-Identifier: MIT
#include "bench/picture.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "bench/failure.h"
#include "run/files/atomic_file.h"

namespace shaken::bench {
namespace {

/// Runs gnuplot on `script` in `folder`; its messages go to our stderr. The exit code, 127 if it could not be started.
int run_gnuplot(const std::filesystem::path& folder, std::string script) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::string program = "gnuplot";
  std::array<char*, 3> arguments{program.data(), script.data(), nullptr};
  pid_t child = 0;
  const int failure = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return 127;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Failure(ExitCode::kFailed, fmt::format("{}: {}", folder.string(), error.message()));
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  if (const auto error = run::write_file_atomically(file, text)) throw Failure(ExitCode::kFailed, error->message);
}

std::string gnuplot_prologue(const std::string& name, int width, int height) {
  return fmt::format(R"(# gnuplot {0}.gp  draws {0}.png from {0}.dat
set terminal pngcairo size {1},{2} enhanced font 'DejaVu Sans,16' linewidth 2 background '#ffffff'
set output '{0}.png'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid y linetype 1 linecolor '#e2e2e2' linewidth 0.5
)",
                     name, width, height);
}

void draw(const std::filesystem::path& folder, const std::string& name, const std::string& data,
          const std::string& script) {
  write_text(folder / (name + ".dat"), data);
  write_text(folder / (name + ".gp"), script);
  const int code = run_gnuplot(folder, name + ".gp");
  if (code == 127) {
    throw Failure(ExitCode::kFailed,
                  "gnuplot is not here: `apt install gnuplot-nox`; the data and the script are in " + folder.string());
  }
  if (code != 0)
    throw Failure(ExitCode::kFailed, fmt::format("gnuplot did not draw {}.png (exit code {})", name, code));
}

}  // namespace shaken::bench
