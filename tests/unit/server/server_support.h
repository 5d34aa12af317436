#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "base/scratch_folder.h"
#include "server/queue/queue.h"

namespace shaken::server {

/// Asks until the answer is yes; false if it still is no after the time.
bool eventually(const std::function<bool()>& condition, std::chrono::milliseconds limit = std::chrono::seconds(20));

void write_text(const std::filesystem::path& file, const std::string& text);
std::string read_text(const std::filesystem::path& file);

/// A program with the command line of shaken-worker that does what its label, or FAKE_WORKER, says:
///   done        writes a summary, exit 0
///   empty       exit 0 without a summary
///   fail        "the gap is closed" on stderr, exit 1
///   progress    exit 1 with a message in progress.json
///   bad         exit 2
///   crash       kills itself with SIGKILL; "crash after checkpoint": with a checkpoint.bin before
///   room        says that there is no space left on the device, exit 97
///   run         runs until SIGTERM, then exit 99
///   late        runs until SIGTERM, then writes a summary and exit 0
///   deaf        runs, ignoring SIGTERM
/// Holds DIR/lock while it runs, and makes DIR/up once it listens to signals.
std::filesystem::path write_fake_worker(const std::filesystem::path& folder);

/// Launches a job; the number of its attempt.
std::optional<int> begin(Queue& queue, const std::string& id);

/// A job named by `digit` repeated 16 times, whose label is `label`.
NewJob new_job(char digit, const std::string& label = "done");

}  // namespace shaken::server
