#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace shaken::server {

/// The page in a browser, a program beside the daemon: whatever a browser sends, the queue is another process. It is
/// started again where it ends by itself, after 1 s, then 2 s, and so on up to a minute.
class WebProgram {
 public:
  explicit WebProgram(std::vector<std::string> command) : command_(std::move(command)) {}
  WebProgram(const WebProgram&) = delete;
  WebProgram& operator=(const WebProgram&) = delete;
  /// Ends it, by force after 3 s.
  ~WebProgram();

  /// Starts it where it does not run and is to; to be called now and then.
  void check();
  /// Asks it to end, and starts it no more.
  void request_stop();

 private:
  using Clock = std::chrono::steady_clock;
  void wait_longer();

  std::vector<std::string> command_;
  pid_t pid_ = 0;  ///< 0: it does not run
  bool is_ending_ = false;
  Clock::time_point started_{}, next_start_{};
  std::chrono::seconds pause_{0};
};

}  // namespace shaken::server
